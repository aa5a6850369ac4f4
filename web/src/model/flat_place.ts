// A flat place that can be a target, in a mesh that does not say where its roofs and squares end: a convex polygon around a
// point, in the plane of a triangle, that stays on the flat surface and in which nothing stands.
//
// The outline of that surface, and what passes through the plane a little above it, are segments of the plane. One after the
// other, from the nearest, those that are not cut off yet are cut off by the line through their nearest point, across the way
// there: of all lines the one that leaves the most around the centre. From the middle of what is left it is tried again. (One
// half of Deits & Tedrake, "Computing Large Convex Regions of Obstacle-Free Space Through Semidefinite Programming", 2015.)
import { cross, dot, minus, plus, times, unit } from "./polygon";
import type { Point } from "../engine/messages";

type Flat = [number, number];
type Segment = [Flat, Flat];

export interface Triangles {
  positions: ArrayLike<number>;
  /** three indices each */
  triangles: ArrayLike<number>;
}

const STARTING_CORNERS = 16;
const TRIES = 6;
const MOST_CORNERS = 24;
const LEAST_LOSS = 0.002; // of the area: a corner that brings less is left out

/**
 * `face`: index of the triangle; `at`: a place on it; `front`: the side it is looked at from; `reach`: how far from its
 * centre the polygon may go; `gap`: what passes through the plane so far above it stands there, and the polygon keeps that
 * distance from it. Empty where there is no room for a polygon.
 */
export function flatPlace(mesh: Triangles, face: number, at: Point, front: Point, reach: number, gap: number): Point[] {
  const corner = (triangle: number, i: number): Point => {
    const k = 3 * mesh.triangles[3 * triangle + i]!;
    return [mesh.positions[k]!, mesh.positions[k + 1]!, mesh.positions[k + 2]!];
  };
  const origin = corner(face, 0);
  const raw = cross(minus(corner(face, 1), origin), minus(corner(face, 2), origin));
  const normal = unit(dot(raw, front) < 0 ? times(raw, -1) : raw);
  const u = unit(cross(Math.abs(normal[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], normal));
  const v = cross(normal, u);
  const flat = (p: Point): Flat => [dot(minus(p, origin), u), dot(minus(p, origin), v)];
  const segments = segmentsOf(mesh.triangles.length / 3, corner, (p) => dot(minus(p, origin), normal), flat, gap);
  return largest(segments, flat(at), reach, gap).map(([x, y]) => plus(origin, plus(times(u, x), times(v, y))));
}

function segmentsOf(
  count: number, corner: (triangle: number, i: number) => Point, height: (p: Point) => number, flat: (p: Point) => Flat, gap: number,
): Segment[] {
  const segments: Segment[] = [];
  const outline = new Map<string, { segment: Segment; count: number }>();
  const seen = new Set<string>(); // some meshes have triangles twice
  for (let triangle = 0; triangle < count; ++triangle) {
    const corners = [corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)];
    const heights = corners.map(height);
    if (Math.max(...heights) < -gap / 10 || Math.min(...heights) > gap) continue;
    if (heights.every((h) => Math.abs(h) <= gap / 10)) addSides(corners, flat, seen, outline);
    else addCrossing(corners, heights, flat, gap, segments);
  }
  for (const side of outline.values()) if (side.count === 1) segments.push(side.segment);
  return segments;
}

/** A side between two triangles of the surface is no part of its outline. */
function addSides(
  corners: Point[], flat: (p: Point) => Flat, seen: Set<string>, outline: Map<string, { segment: Segment; count: number }>,
): void {
  const keys = corners.map(String);
  const whole = [...keys].sort().join(" ");
  if (seen.has(whole)) return;
  seen.add(whole);
  for (let i = 0; i < 3; ++i) {
    const j = (i + 1) % 3;
    const key = [keys[i]!, keys[j]!].sort().join(" ");
    const side = outline.get(key);
    if (side) ++side.count;
    else outline.set(key, { segment: [flat(corners[i]!), flat(corners[j]!)], count: 1 });
  }
}

/** Where a triangle passes through the plane at the height of the gap. */
function addCrossing(corners: Point[], heights: number[], flat: (p: Point) => Flat, gap: number, segments: Segment[]): void {
  const ends: Flat[] = [];
  for (let i = 0; i < 3; ++i) {
    const j = (i + 1) % 3;
    const [from, to] = [heights[i]! - gap, heights[j]! - gap];
    if (from >= 0 === to >= 0) continue;
    ends.push(flat(plus(corners[i]!, times(minus(corners[j]!, corners[i]!), from / (from - to)))));
  }
  if (ends.length === 2) segments.push(ends as Segment);
}

function nearest([a, b]: Segment, [x, y]: Flat): Flat {
  const along: Flat = [b[0] - a[0], b[1] - a[1]];
  const square = along[0] ** 2 + along[1] ** 2;
  const t = square === 0 ? 0 : Math.min(1, Math.max(0, ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / square));
  return [a[0] + t * along[0], a[1] + t * along[1]];
}

/** Half a plane: where across · p <= bound. */
interface Side {
  across: Flat;
  bound: number;
}

const beyond = ({ across, bound }: Side, p: Flat) => across[0] * p[0] + across[1] * p[1] - bound;

function clipped(polygon: Flat[], side: Side): Flat[] {
  const left: Flat[] = [];
  polygon.forEach((from, i) => {
    const to = polygon[(i + 1) % polygon.length]!;
    const [a, b] = [beyond(side, from), beyond(side, to)];
    if (a <= 0) left.push(from);
    if (a <= 0 !== b <= 0) left.push([from[0] + ((to[0] - from[0]) * a) / (a - b), from[1] + ((to[1] - from[1]) * a) / (a - b)]);
  });
  return left;
}

function around(segments: Segment[], centre: Flat, reach: number, gap: number): Flat[] {
  const near = segments
    .map((segment) => {
      const to = nearest(segment, centre);
      return { segment, to, distance: Math.hypot(to[0] - centre[0], to[1] - centre[1]) };
    })
    .filter(({ distance }) => distance < reach + gap)
    .sort((a, b) => a.distance - b.distance);
  let polygon = Array.from({ length: STARTING_CORNERS }, (_, i): Flat => {
    const angle = (2 * Math.PI * i) / STARTING_CORNERS;
    return [centre[0] + reach * Math.cos(angle), centre[1] + reach * Math.sin(angle)];
  });
  const sides: Side[] = [];
  for (const { segment, to, distance } of near) {
    if (distance <= gap) return [];
    if (sides.some((side) => segment.every((end) => beyond(side, end) >= gap))) continue;
    const across: Flat = [(to[0] - centre[0]) / distance, (to[1] - centre[1]) / distance];
    const side = { across, bound: across[0] * to[0] + across[1] * to[1] - gap };
    sides.push(side);
    polygon = clipped(polygon, side);
  }
  return polygon;
}

function areaOf(polygon: Flat[]): number {
  return polygon.reduce((sum, a, i) => {
    const b = polygon[(i + 1) % polygon.length]!;
    return sum + (a[0] * b[1] - a[1] * b[0]) / 2;
  }, 0);
}

const middleOf = (polygon: Flat[]): Flat => {
  const sum = polygon.reduce<Flat>((all, p) => [all[0] + p[0], all[1] + p[1]], [0, 0]);
  return [sum[0] / polygon.length, sum[1] / polygon.length];
};

function holds(polygon: Flat[], p: Flat): boolean {
  return polygon.every((a, i) => {
    const b = polygon[(i + 1) % polygon.length]!;
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0;
  });
}

function largest(segments: Segment[], at: Flat, reach: number, gap: number): Flat[] {
  let best = around(segments, at, reach, gap);
  for (let i = 0; i < TRIES && best.length > 0; ++i) {
    const other = around(segments, middleOf(best), reach, gap);
    if (!holds(other, at) || areaOf(other) <= areaOf(best)) break;
    best = other;
  }
  return withoutSmallCorners(best);
}

/** What is left out of a convex polygon makes it smaller, never larger. */
function withoutSmallCorners(polygon: Flat[]): Flat[] {
  let left = polygon;
  const all = areaOf(polygon);
  while (left.length > 3) {
    const losses = left.map((p, i) => areaOf([left[(i + left.length - 1) % left.length]!, p, left[(i + 1) % left.length]!]));
    const least = Math.min(...losses);
    if (left.length <= MOST_CORNERS && least > LEAST_LOSS * all) break;
    const index = losses.indexOf(least);
    left = left.filter((_, i) => i !== index);
  }
  return left;
}
