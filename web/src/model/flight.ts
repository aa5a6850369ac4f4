// A flight as `vantage check` tells of it: where it goes, when, and from where which target is seen.
import type { Point } from "../engine/messages";

/** Of the axis: from one value to another. Both ends belong to it. */
export type Span = [number, number];

export interface FlightTarget {
  name: string;
  /** it is flown through: `seen` is where the flight is inside it */
  isVolume: boolean;
  /** convex polygons, scene frame */
  parts: Point[][];
  /** where on the axis all of it is seen; sorted, apart */
  seen: Span[];
  /** the same along the flight, metres */
  seen_m: Span[];
}

/** The line of sight, or the radio link, from a point to the vehicle. */
export interface FlightLink {
  name: string;
  /** where on the axis it holds; sorted, apart */
  linked: Span[];
}

/** A moment of a flight. */
export interface Moment {
  at: Point;
  /** along the flight */
  at_m: number;
  /** since it began; null: nobody knows how fast it is flown */
  at_s: number | null;
  /** indices of the targets that are seen whole, or that it is inside of */
  seen: number[];
}

export interface Flight {
  name: string;
  /** the ground where it takes off; null: not told */
  home: Point | null;
  /** what the axis counts: seconds where all speeds are known, else metres */
  unit: "s" | "m";
  /** of the axis, which begins at 0 */
  end: number;
  points: { at: Point; at_m: number; arrival: number; departure: number }[];
  targets: FlightTarget[];
  links: FlightLink[];
  /** what was required and does not hold */
  failures: string[];
  /** what to know before relying on it */
  notes: string[];
  /** all holds for every position so near to it, metres */
  tube_m: number;
}

const AGAIN = "write it again: vantage check mission.yaml PLAN -o check.json";

/** Reads members, and says which of them is wrong. */
class Reader {
  constructor(private readonly value: unknown, private readonly path: string) {}

  private fail(what: string): never {
    throw new Error(`${this.path} ${what}: ${AGAIN}`);
  }

  get(key: string): Reader {
    const { value } = this;
    if (typeof value !== "object" || value === null || Array.isArray(value)) this.fail("is no object");
    if (!Object.hasOwn(value, key)) this.fail(`has no "${key}"`);
    return new Reader((value as Record<string, unknown>)[key], `${this.path}, ${key}`);
  }

  /** of a member that checks of earlier versions have not */
  find(key: string): Reader | null {
    return Object.hasOwn(this.value as object, key) ? this.get(key) : null;
  }

  list<T>(read: (one: Reader) => T): T[] {
    const { value } = this;
    if (!Array.isArray(value)) this.fail("is no list");
    return value.map((one, i) => read(new Reader(one, `${this.path} ${i + 1}`)));
  }

  number(): number {
    const { value } = this;
    return typeof value === "number" && Number.isFinite(value) ? value : this.fail("is no number");
  }

  /** null: not known */
  known(): number | null {
    return this.value === null ? null : this.number();
  }

  flag(): boolean {
    return typeof this.value === "boolean" ? this.value : this.fail("is neither true nor false");
  }

  text(): string {
    return typeof this.value === "string" ? this.value : this.fail("is no text");
  }

  point(): Point {
    return [this.get("x_m").number(), this.get("y_m").number(), this.get("z_m").number()];
  }
}

function inOrder(values: number[], what: string): void {
  const at = values.findIndex((value, i) => i > 0 && value < values[i - 1]!);
  if (at > 0) throw new Error(`${what} ${at + 1} comes before the one before it: ${AGAIN}`);
}

/** `most`: the end of the flight, in that unit. */
function spansFrom(spans: Reader, unit: "s" | "m", most: number): Span[] {
  return spans.list((span): Span => {
    const ends: Span = [span.get(`begin_${unit}`).number(), span.get(`end_${unit}`).number()];
    const slack = 1e-9 * most;
    if (!(ends[0] >= 0 && ends[0] <= ends[1] && ends[1] <= most + slack)) {
      throw new Error(`a stretch from ${ends[0]} to ${ends[1]} ${unit} is no part of the flight: ${AGAIN}`);
    }
    return ends;
  });
}

function targetFrom(target: Reader, unit: "s" | "m", end: number, end_m: number): FlightTarget {
  return {
    name: target.get("name").text(),
    isVolume: target.find("volume")?.flag() ?? false,
    parts: target.get("parts").list((part) => part.list((corner) => corner.point())),
    seen: spansFrom(target.get("seen"), unit, end),
    seen_m: spansFrom(target.get("seen"), "m", end_m),
  };
}

/** `told`: what check.json holds. Throws an Error that says what is wrong with it. */
export function flightFrom(told: unknown, name: string, home: Point | null = null, notes: string[] = []): Flight {
  const check = new Reader(told, name);
  const places = check.get("points").list((point) => ({
    at: point.get("position").point(), at_m: point.get("at_m").number(),
    arrival_s: point.get("arrival_s").known(), departure_s: point.get("departure_s").known(),
  }));
  if (places.length === 0) throw new Error(`${name} has no points: ${AGAIN}`);
  const isTimed = places.every(({ arrival_s, departure_s }) => arrival_s !== null && departure_s !== null);
  const points = places.map(({ at, at_m, arrival_s, departure_s }) => ({
    at, at_m, arrival: isTimed ? arrival_s! : at_m, departure: isTimed ? departure_s! : at_m,
  }));
  inOrder(points.map(({ at_m }) => at_m), `${name}, points: number`);
  inOrder(points.flatMap(({ arrival, departure }) => [arrival, departure]), `${name}, points: time`);
  const { departure, at_m } = points.at(-1)!;
  const unit = isTimed ? "s" : "m";
  return {
    name, home, unit, end: departure, points,
    notes: [...notes, ...(check.find("notes")?.list((one) => one.text()) ?? [])],
    targets: check.get("targets").list((target) => targetFrom(target, unit, departure, at_m)),
    links: check.find("links")?.list((link) => ({
      name: link.get("name").text(), linked: spansFrom(link.get("linked"), unit, departure),
    })) ?? [],
    failures: [
      ...(check.find("not_judged")?.list((one) => `not judged: ${one.text()}`) ?? []),
      ...check.get("failures").list((one) => one.text()),
    ],
    tube_m: check.get("tube_radius_m").number(),
  };
}

/** Whether a text, of which this is the beginning, is what `vantage check` writes, whole or not. */
export const isFlight = (head: string): boolean => /^\ufeff?\s*\{\s*"(passes|failures|broken|duration_s)"\s*:/.test(head);

/** Index of the last entry whose value is not above `value`; 0 where there is none. The values are sorted. */
function lastAt<T>(list: T[], value: number, of: (one: T) => number): number {
  let [low, high] = [0, list.length];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (of(list[middle]!) <= value) low = middle;
    else high = middle;
  }
  return low;
}

const mixed = (from: Point, to: Point, share: number): Point =>
  [0, 1, 2].map((i) => from[i]! + share * (to[i]! - from[i]!)) as unknown as Point;

/** `x`: on the axis; beyond its ends it is the end. */
export function momentAt({ points, targets, unit, end }: Flight, x: number): Moment {
  const on = Math.min(Math.max(x, 0), end);
  const i = lastAt(points, on, ({ arrival }) => arrival);
  const [from, to] = [points[i]!, points[i + 1]];
  const share = to && on > from.departure ? (on - from.departure) / (to.arrival - from.departure) : 0;
  return {
    at: to ? mixed(from.at, to.at, share) : from.at, at_m: to ? from.at_m + share * (to.at_m - from.at_m) : from.at_m,
    at_s: unit === "s" ? on : null,
    seen: targets.flatMap(({ seen }, index) => (seen.some(([begin, last]) => begin <= on && on <= last) ? [index] : [])),
  };
}

/** Its points and its ends from one place to another, metres along it. */
export function stretch({ points }: Flight, [begin, end]: Span): Point[] {
  const at = (place: number): Point => {
    const i = lastAt(points, place, ({ at_m }) => at_m);
    const [from, to] = [points[i]!, points[i + 1]];
    return to && place > from.at_m ? mixed(from.at, to.at, (place - from.at_m) / (to.at_m - from.at_m)) : from.at;
  };
  // There may be a million points and thousands of stretches.
  const first = lastAt(points, begin, ({ at_m }) => at_m);
  const inside = points.slice(first, lastAt(points, end, ({ at_m }) => at_m) + 1);
  return [at(begin), ...inside.filter(({ at_m }) => at_m > begin && at_m < end).map((point) => point.at), at(end)];
}

/** Lowest and highest coordinates. */
export function boundsOf({ points }: Flight): { min: Point; max: Point } {
  const [min, max]: [Point, Point] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (const { at } of points) {
    at.forEach((value, i) => {
      min[i] = Math.min(min[i]!, value);
      max[i] = Math.max(max[i]!, value);
    });
  }
  return { min, max };
}

/** Round numbers from 0 to the end, about so many. */
export function ticks(end: number, about: number): number[] {
  if (!(end > 0)) return [0];
  const rough = end / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10);
  return Array.from({ length: Math.floor(end / step + 1e-9) + 1 }, (_, i) => i * step);
}
