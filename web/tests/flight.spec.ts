// What the page reads of a flight, and where on it what is: without a browser.
import { expect, test } from "@playwright/test";
import { boundsOf, flightFrom, isFlight, momentAt, stretch, ticks } from "../src/model/flight";
import { heightsBelow } from "../src/model/heights_below";

const at = (x_m: number, y_m: number, z_m: number) => ({ x_m, y_m, z_m });
const span = (begin_m: number, end_m: number, begin_s: number | null, end_s: number | null) => ({ begin_m, end_m, begin_s, end_s });

/** 30 m east at 10 m/s, 4 s there, 20 m north at 5 m/s. */
const check = () => ({
  passes: true, failures: [] as string[], length_m: 50, duration_s: 11 as number | null, tube_radius_m: 0,
  targets: [
    { name: "a", parts: [[at(0, 0, 0), at(1, 0, 0), at(0, 1, 0)]], seen: [span(10, 30, 1, 7)] },
    { name: "b", parts: [], seen: [span(30, 50, 3, 11)] },
    { name: "c", parts: [], seen: [] },
  ],
  points: [
    { at_m: 0, arrival_s: 0 as number | null, departure_s: 0 as number | null, position: at(0, 0, 40) },
    { at_m: 30, arrival_s: 3, departure_s: 7, position: at(30, 0, 40) },
    { at_m: 50, arrival_s: 11, departure_s: 11, position: at(30, 20, 60) },
  ],
});

test("a flight is somewhere at each moment, and sees what it sees there", () => {
  const flight = flightFrom(check(), "check.json");
  expect([flight.unit, flight.end]).toEqual(["s", 11]);
  const shown = (x: number) => {
    const { at: place, at_m, seen } = momentAt(flight, x);
    return [place, at_m, seen];
  };
  expect(shown(-1)).toEqual([[0, 0, 40], 0, []]);
  expect(shown(1)).toEqual([[10, 0, 40], 10, [0]]);
  expect(shown(3)).toEqual([[30, 0, 40], 30, [0, 1]]);
  expect(shown(6.9)).toEqual([[30, 0, 40], 30, [0, 1]]); // it stays
  expect(shown(9)).toEqual([[30, 10, 50], 40, [1]]);
  expect(shown(99)).toEqual([[30, 20, 60], 50, [1]]);
  expect(momentAt(flight, 0.999).seen).toEqual([]); // a stretch is never made longer
  expect(stretch(flight, [20, 40])).toEqual([[20, 0, 40], [30, 0, 40], [30, 10, 50]]);
  expect(boundsOf(flight)).toEqual({ min: [0, 0, 40], max: [30, 20, 60] });
});

test("without speeds its axis counts metres", () => {
  const slow = check();
  for (const point of slow.points) point.arrival_s = point.departure_s = null;
  for (const target of slow.targets) for (const one of target.seen) one.begin_s = one.end_s = null;
  const flight = flightFrom(slow, "check.json");
  expect([flight.unit, flight.end]).toEqual(["m", 50]);
  expect(momentAt(flight, 40)).toEqual({ at: [30, 10, 50], at_m: 40, at_s: null, seen: [1] });
  expect(momentAt(flightFrom({ ...slow, points: slow.points.slice(0, 1), targets: [] }, "one point"), 0).at).toEqual([0, 0, 40]);
});

test("volumes are flown through, and links hold or not", () => {
  const [a, b, c] = check().targets;
  const links = [{ name: "pilot", linked: [span(0, 30, 0, 7)], lost: [] }, { name: "mast", linked: [] }];
  const flight = flightFrom({ ...check(), targets: [a, { ...b, volume: true }, c], links }, "check.json");
  expect(flight.targets.map(({ isVolume }) => isVolume)).toEqual([false, true, false]);
  expect(flight.links).toEqual([{ name: "pilot", linked: [[0, 7]] }, { name: "mast", linked: [] }]);
  expect(flightFrom(check(), "of an earlier version").links).toEqual([]);
  expect(flightFrom({ ...check(), notes: ["beyond the map"] }, "check.json", null, ["of the plan"]).notes).toEqual(["of the plan", "beyond the map"]);
  const far = [{ name: "pilot", linked: [span(0, 30, 0, 12)] }];
  expect(() => flightFrom({ ...check(), links: far }, "check.json")).toThrow("from 0 to 12 s is no part");
  expect(() => flightFrom({ ...check(), targets: [{ ...a, volume: 1 }] }, "check.json")).toThrow("volume is neither true nor false");
});

test("what is no flight is refused, and what is wrong is named", () => {
  const broken: [(told: any) => void, string][] = [
    [(told) => delete told.points, 'check.json has no "points"'],
    [(told) => (told.points = []), "has no points"],
    [(told) => delete told.points[1].position, 'points 2 has no "position"'],
    [(told) => (told.points[1].position.z_m = "high"), "points 2, position, z_m is no number"],
    [(told) => (told.points[2].at_m = 20), "number 3 comes before"],
    [(told) => (told.points[2].arrival_s = 6), "time 5 comes before"],
    [(told) => (told.targets[0].seen[0].end_s = 12), "from 1 to 12 s is no part"],
    [(told) => (told.targets[0].seen[0].begin_m = 31), "from 31 to 30"],
    [(told) => (told.targets[1].name = 5), "targets 2, name is no text"],
    [(told) => (told.targets = {}), "targets is no list"],
    [(told) => (told.failures = null), "failures is no list"],
  ];
  for (const [breaks, message] of broken) {
    const told = check();
    breaks(told);
    expect(() => flightFrom(told, "check.json"), message).toThrow(message);
    expect(() => flightFrom(told, "check.json")).toThrow("vantage check");
  }
  for (const told of [null, 3, [], "x"]) expect(() => flightFrom(told, "check.json")).toThrow("is no object");
});

test("a check is told from other JSON by its beginning", () => {
  expect(isFlight(JSON.stringify(check()))).toBe(true);
  expect(isFlight('\ufeff{\n  "broken": [')).toBe(true);
  for (const text of ['{"type": "CityJSON"', "", "[1]", '{"type": "FeatureCollection"', '{"asset": {']) expect(isFlight(text)).toBe(false);
});

test("an axis has round numbers", () => {
  expect(ticks(237.5, 6)).toEqual([0, 50, 100, 150, 200]);
  expect(ticks(100, 5)).toEqual([0, 20, 40, 60, 80, 100]);
  expect(ticks(0, 6)).toEqual([0]);
});

test("heights below are those of the highest triangle", () => {
  // A slope z = x / 10, and a roof at 20 over a part of it.
  const slope = [[0, 0, 0], [100, 0, 10], [100, 100, 10], [0, 100, 0]], roof = [[10, 10, 20], [30, 10, 20], [10, 30, 20]];
  const positions = [...slope, ...roof].flat();
  const triangles = [0, 1, 2, 0, 2, 3, 4, 5, 6];
  const places = [[50, 50], [15, 15], [200, 5], [0, 0], [29, 29], [-1e-3, 50]].map((place) => [...place, 40]);
  expect([...heightsBelow({ positions, triangles }, places)]).toEqual([5, 20, NaN, 0, 2.9, NaN]);
  expect([...heightsBelow({ positions, triangles: triangles.slice(0, 6) }, places)]).toEqual([5, 1.5, NaN, 0, 2.9, NaN]);
  const alone = places.map((place) => heightsBelow({ positions, triangles }, [place])[0]);
  expect(alone).toEqual([5, 20, NaN, 0, 2.9, NaN]); // whatever the other places are
  // Under the roof the slope is what lies below; on the roof, as rounded as plans are, the roof.
  const under = [[15, 15, 12], [15, 15, 19.99], [15, 15, 19.9], [15, 15, 1], [50, 50, 4]];
  expect([...heightsBelow({ positions, triangles }, under)]).toEqual([1.5, 20, 1.5, NaN, NaN]);
});
