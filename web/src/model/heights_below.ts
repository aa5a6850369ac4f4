// How high the highest surface below a place is.

export interface Triangles {
  positions: ArrayLike<number>;
  triangles: ArrayLike<number>;
}

/** z of a triangle's plane at a place, within the triangle's own heights; NaN: it does not lie there, or stands upright. */
function heightAt(p: ArrayLike<number>, a: number, b: number, c: number, x: number, y: number): number {
  const across = (i: number, j: number) => (p[i]! - x) * (p[j + 1]! - y) - (p[j]! - x) * (p[i + 1]! - y);
  const [u, v, w] = [across(b, c), across(c, a), across(a, b)];
  if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) return NaN;
  const whole = u + v + w;
  const [low, high] = [Math.min(p[a + 2]!, p[b + 2]!, p[c + 2]!), Math.max(p[a + 2]!, p[b + 2]!, p[c + 2]!)];
  return whole === 0 ? high : Math.min(high, Math.max(low, (u * p[a + 2]! + v * p[b + 2]! + w * p[c + 2]!) / whole));
}

/** The places by squares, so that each triangle is held against those near it alone. */
class Grid {
  private readonly cells = new Map<number, number[]>();
  private readonly low: [number, number] = [Infinity, Infinity];
  private readonly high: [number, number] = [-Infinity, -Infinity];
  private readonly columns: number;
  private readonly size: number;

  constructor(places: readonly (readonly number[])[]) {
    for (const place of places) {
      for (const axis of [0, 1] as const) {
        this.low[axis] = Math.min(this.low[axis], place[axis]!);
        this.high[axis] = Math.max(this.high[axis], place[axis]!);
      }
    }
    this.columns = Math.max(1, Math.ceil(Math.sqrt(places.length)));
    this.size = Math.max(this.high[0] - this.low[0], this.high[1] - this.low[1], 1e-9) / this.columns;
    places.forEach((place, i) => {
      const cell = this.cell(place[0]!, 0) + (this.columns + 1) * this.cell(place[1]!, 1);
      this.cells.set(cell, [...(this.cells.get(cell) ?? []), i]);
    });
  }

  private cell(value: number, axis: 0 | 1): number {
    return Math.floor((value - this.low[axis]) / this.size);
  }

  each(left: number, right: number, bottom: number, top: number, act: (index: number) => void): void {
    if (left > this.high[0] || right < this.low[0] || bottom > this.high[1] || top < this.low[1]) return;
    const [from, to] = [Math.max(0, this.cell(left, 0)), Math.min(this.columns, this.cell(right, 0))];
    const last = Math.min(this.columns, this.cell(top, 1));
    for (let row = Math.max(0, this.cell(bottom, 1)); row <= last; ++row) {
      for (let column = from; column <= to; ++column) this.cells.get(column + (this.columns + 1) * row)?.forEach(act);
    }
  }
}

/** Metres: positions of plans are rounded, and so is what is drawn. What is so little above a place lies below it still. */
const ROUNDING = 0.05;

/** z for each place (x, y, z); NaN: nothing lies below it. Triangles and places are in the same frame. */
export function heightsBelow({ positions: p, triangles }: Triangles, places: readonly (readonly number[])[]): Float64Array {
  const heights = new Float64Array(places.length).fill(NaN);
  const squares = new Grid(places);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!];
    const [left, right] = [Math.min(p[a]!, p[b]!, p[c]!), Math.max(p[a]!, p[b]!, p[c]!)];
    const [bottom, top] = [Math.min(p[a + 1]!, p[b + 1]!, p[c + 1]!), Math.max(p[a + 1]!, p[b + 1]!, p[c + 1]!)];
    squares.each(left, right, bottom, top, (index) => {
      const [x, y, from] = places[index] as [number, number, number];
      if (x < left || x > right || y < bottom || y > top) return;
      const z = heightAt(p, a, b, c, x, y);
      if (z <= from + ROUNDING && !(heights[index]! >= z)) heights[index] = z;
    });
  }
  return heights;
}
