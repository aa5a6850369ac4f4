// Polygons in a plane of space: whether they can be targets, and why not.
import type { Point } from "../engine/messages";

export const minus = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const plus = (a: Point, b: Point): Point => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const times = (a: Point, f: number): Point => [a[0] * f, a[1] * f, a[2] * f];
export const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Point, b: Point): Point => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Point): number => Math.sqrt(dot(a, a));
export const unit = (a: Point): Point => times(a, 1 / (length(a) || 1));

export interface Plane {
  origin: Point;
  normal: Point;
}

export function centreOf(points: Point[]): Point {
  return times(points.reduce(plus, [0, 0, 0]), 1 / Math.max(1, points.length));
}

/** Twice the area, along the normal (Newell). */
export function areaVector(points: Point[]): Point {
  let sum: Point = [0, 0, 0];
  points.forEach((a, i) => {
    sum = plus(sum, cross(minus(a, points[0]!), minus(points[(i + 1) % points.length]!, points[0]!)));
  });
  return sum;
}

/** Corners that face along the normal of the plane: counter-clockwise seen against it. */
export function facing(points: Point[], normal: Point): Point[] {
  return dot(areaVector(points), normal) < 0 ? [...points].reverse() : points;
}

export interface Fault {
  /** index of the corner */
  corner: number;
  reason: string;
}

/** Why the corners are not a convex polygon; null: they are one. */
export function faultOf(points: Point[]): Fault | null {
  if (points.length < 3) return { corner: points.length - 1, reason: "a target has three corners or more" };
  if (points.length > 64) return { corner: points.length - 1, reason: "a target has 64 corners at most" };
  const area = areaVector(points);
  const normal = unit(area);
  const sides = points.map((point, i) => minus(points[(i + 1) % points.length]!, point));
  const around = sides.reduce((sum, side) => sum + length(side), 0);
  if (length(area) < 1e-9 * around * around) return { corner: 0, reason: "the corners lie on one line" };
  let turned = 0;
  for (let i = 0; i < points.length; ++i) {
    const before = sides[(i + points.length - 1) % points.length]!;
    const after = sides[i]!;
    if (length(after) < 1e-6 * around) return { corner: i, reason: "two corners are in one place" };
    const turn = Math.atan2(dot(cross(before, after), normal), dot(before, after));
    if (turn < -1e-9) return { corner: i, reason: "the polygon is not convex here: pull this corner outward" };
    turned += turn;
  }
  if (turned > 2 * Math.PI + 1e-3) return { corner: 0, reason: "the sides cross each other" };
  return null;
}
