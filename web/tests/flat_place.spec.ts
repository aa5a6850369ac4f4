// Flat places in drawn towns: convex, around the click, on the surface, and nothing stands in them.
import { expect, test } from "@playwright/test";
import type { Point } from "../src/engine/messages";
import { flatPlace } from "../src/model/flat_place";
import { areaVector, cross, dot, faultOf, length, minus, plus, times, unit } from "../src/model/polygon";

interface Block {
  low: [number, number];
  high: [number, number];
}

/** Mulberry32. */
function randomOf(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** A square ground of two triangles, and blocks on it without floors; a plane of space may carry it. */
class Town {
  readonly positions: number[] = [];
  readonly triangles: number[] = [];

  constructor(readonly size: number, readonly blocks: Block[], private readonly place: (p: Point) => Point) {
    const s = size;
    this.quad([0, 0, 0], [s, 0, 0], [s, s, 0], [0, s, 0]);
    for (const { low: [x, y], high: [u, v] } of blocks) {
      const h = size / 10;
      const ring: [number, number][] = [[x, y], [u, y], [u, v], [x, v]];
      ring.forEach(([a, b], i) => {
        const [c, d] = ring[(i + 1) % 4]!;
        this.quad([a, b, 0], [c, d, 0], [c, d, h], [a, b, h]);
      });
      this.quad([x, y, h], [u, y, h], [u, v, h], [x, v, h]);
    }
  }

  private quad(...corners: Point[]): void {
    const first = this.positions.length / 3;
    for (const corner of corners) this.positions.push(...this.place(corner));
    this.triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
  }
}

/** How far two convex polygons of the plane are apart; 0: they meet. By the separating axes of their sides. */
function apart(a: [number, number][], b: [number, number][]): number {
  let best = 0;
  for (const [from, other] of [[a, b], [b, a]] as const) {
    from.forEach(([x, y], i) => {
      const [u, v] = from[(i + 1) % from.length]!;
      const across: [number, number] = [(v - y) / Math.hypot(u - x, v - y), (x - u) / Math.hypot(u - x, v - y)];
      const at = across[0] * x + across[1] * y;
      best = Math.max(best, Math.min(...other.map((p) => across[0] * p[0] + across[1] * p[1] - at)));
    });
  }
  return best;
}

test("in drawn towns", () => {
  const seed = Number(process.env.VANTAGE_SEED ?? 20261124);
  console.log(`seed ${seed}`);
  const random = randomOf(seed);
  let found = 0;
  for (let draw = 0; draw < 300; ++draw) {
    const size = 10 ** (random() * 7 - 3);
    const normal = unit([random() - 0.5, random() - 0.5, random() - 0.5]);
    const u = unit(cross(normal, Math.abs(normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const v = cross(normal, u);
    const isLevel = draw % 2 === 0;
    const place = (p: Point): Point => (isLevel ? p : plus(times(u, p[0]), plus(times(v, p[1]), times(normal, p[2]))));
    const blocks = Array.from({ length: 1 + Math.floor(random() * 12) }, (): Block => {
      const [x, y, w, d] = [random() * size * 0.8, random() * size * 0.8, random() * size * 0.2 + size / 500, random() * size * 0.2 + size / 500];
      return { low: [x, y], high: [x + w, y + d] };
    });
    const at: [number, number] = [random() * size, random() * size];
    if (blocks.some(({ low, high }) => at.every((c, i) => c > low[i]! - size / 100 && c < high[i]! + size / 100))) continue;
    const town = new Town(size, blocks, place);
    const gap = 1e-4 * size;
    const reach = size * (0.05 + random());
    const front = isLevel ? [0, 0, 1] as Point : normal;
    const corners = flatPlace(town, draw % 4 < 2 ? 0 : 1, place([...at, 0]), front, reach, gap);
    const isAtEdge = at.some((c) => c < 2 * gap || c > size - 2 * gap);
    if (corners.length === 0) {
      expect(isAtEdge, `draw ${draw}`).toBe(true);
      continue;
    }
    ++found;
    expect(faultOf(corners), `draw ${draw}`).toBe(null);
    expect(dot(areaVector(corners), front), `draw ${draw}`).toBeGreaterThan(0);
    const back = (p: Point): [number, number] => (isLevel ? [p[0], p[1]] : [dot(p, u), dot(p, v)]);
    const flat = corners.map(back);
    for (const corner of corners) expect(Math.abs(isLevel ? corner[2] : dot(corner, normal))).toBeLessThan(1e-9 * size);
    for (const p of flat) for (const c of p) expect(c > 0.5 * gap && c < size - 0.5 * gap, `draw ${draw}`).toBe(true);
    for (const { low, high } of blocks) {
      const ring: [number, number][] = [low, [high[0], low[1]], high, [low[0], high[1]]];
      expect(apart(flat, ring), `draw ${draw}`).toBeGreaterThan(0.5 * gap);
    }
    // The click is inside, but for the corners that are too small to matter.
    flat.forEach(([x, y], i) => {
      const [a, b] = flat[(i + 1) % flat.length]!;
      const out = ((b - y) * (at[0] - x) - (a - x) * (at[1] - y)) / Math.hypot(a - x, b - y);
      expect(out, `draw ${draw}`).toBeLessThan(0.1 * reach);
    });
    const widest = Math.max(...corners.map((p) => length(minus(p, corners[0]!))));
    expect(widest).toBeLessThan(2.001 * reach);
  }
  expect(found).toBeGreaterThan(150);
});

test("an empty square is taken whole, and a wall up to its outline", () => {
  const town = new Town(100, [{ low: [40, 40], high: [60, 60] }], (p) => p);
  const empty = flatPlace(new Town(100, [], (p) => p), 0, [50, 50, 0], [0, 0, 1], 200, 0.01);
  expect(empty.length).toBe(4);
  expect(length(areaVector(empty)) / 2).toBeCloseTo(99.98 ** 2, 6);
  const wall = flatPlace(town, 2, [50, 40, 5], [0, -1, 0], 50, 0.01);
  expect(length(areaVector(wall)) / 2).toBeCloseTo(19.98 * 9.98, 6);
  for (const [, y] of wall) expect(y).toBeCloseTo(40, 9);
});

test("triangles that are there twice do not hide the outline", () => {
  const town = new Town(100, [], (p) => p);
  const twice = { positions: town.positions, triangles: [...town.triangles, ...town.triangles] };
  for (const [x, y] of flatPlace(twice, 0, [5, 5, 0], [0, 0, 1], 80, 0.01)) {
    expect(Math.min(x, y, 100 - x, 100 - y)).toBeGreaterThan(0.009);
  }
});
