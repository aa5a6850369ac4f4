// Loads a flight in CZML with Cesium, and compares it with what `vantage check --json` says of the same flight:
//
//     node czml.mjs CESIUM tour.czml check.json ELLIPSOID_Z
//
// CESIUM is the folder of the npm package "cesium", ELLIPSOID_Z the scene's z of the ellipsoid, metres:
// scene.sea_level (0 above a geoid) less what --undulation was given. Positions are compared at every waypoint, when
// the vehicle comes and goes, and in the middle of every leg; the property "seen" of every target in the middle of each
// stretch and a millisecond before and behind it. Exit code 1 where a position is off by more than a millimetre, or a
// time is wrong.
// check_czml.sh beside this file runs it.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const MOST_M = 1e-3, MILLISECOND = 1e-3;
const [folder, czmlFile, checkFile, ellipsoidZ] = process.argv.slice(2);
for (const name of ["Image", "HTMLImageElement", "HTMLCanvasElement", "HTMLVideoElement"]) {
  globalThis[name] ??= class {}; // Cesium asks whether a value is one of these; in CZML of flights none is
}
const Cesium = createRequire(import.meta.url)(path.resolve(folder));

const czml = JSON.parse(readFileSync(czmlFile, "utf8"));
const check = JSON.parse(readFileSync(checkFile, "utf8"));
const source = await Cesium.CzmlDataSource.load(czml);
const start = source.clock.startTime;
const at = (seconds) => Cesium.JulianDate.addSeconds(start, seconds, new Cesium.JulianDate());
const vehicle = source.entities.getById("vehicle");
let failures = 0, compared = 0, worst = 0;

function fail(text) {
  failures += 1;
  console.error(text);
}

const cartesian = (p) =>
  Cesium.Cartesian3.fromDegrees(p.lon_deg, p.lat_deg, p.z_m - Number(ellipsoidZ));

function compare(seconds, expected, what) {
  const found = vehicle.position.getValue(at(seconds));
  if (!found) return fail(`${what}: no position at ${seconds} s`);
  const off = Cesium.Cartesian3.distance(found, expected);
  compared += 1;
  worst = Math.max(worst, off);
  if (off > MOST_M) fail(`${what}: off by ${off} m at ${seconds} s`);
}

const points = check.points;
points.forEach((point, i) => {
  const here = cartesian(point.position);
  compare(point.arrival_s, here, `point ${i + 1}`);
  compare(point.departure_s, here, `point ${i + 1}, leaving`);
  if (i === 0) return;
  const before = points[i - 1];
  const middle = {};
  for (const key of ["lon_deg", "lat_deg", "z_m"]) {
    middle[key] = (before.position[key] + point.position[key]) / 2;
  }
  compare((before.departure_s + point.arrival_s) / 2, cartesian(middle), `leg ${i}`);
});

let stretches = 0;
check.targets.forEach((target, i) => {
  const entity = source.entities.getById(`target ${i + 1}`);
  if (!entity || entity.name !== target.name) return fail(`target ${i + 1} is not ${target.name}`);
  const seen = (seconds) => entity.properties.seen.getValue(at(seconds));
  for (const span of target.seen) {
    stretches += 1;
    if (seen((span.begin_s + span.end_s) / 2) !== true) fail(`${target.name}: not seen from ${span.begin_s} s on`);
    if (span.begin_s > MILLISECOND && seen(span.begin_s - MILLISECOND) !== false) {
      fail(`${target.name}: seen too early`);
    }
    if (span.end_s < check.duration_s - MILLISECOND && seen(span.end_s + MILLISECOND) !== false) {
      fail(`${target.name}: seen too long`);
    }
  }
});

const length = Cesium.JulianDate.secondsDifference(source.clock.stopTime, start);
if (Math.abs(length - check.duration_s) > MILLISECOND) {
  fail(`the clock runs ${length} s, the flight takes ${check.duration_s} s`);
}
if (compared === 0 || stretches === 0) fail("nothing was compared");
console.log(`${compared} positions, off by ${(worst * 1e3).toFixed(4)} mm at most; ${stretches} stretches in which a ` +
            `target is seen; ${length.toFixed(1)} s; ${failures} failures`);
process.exit(failures === 0 ? 0 : 1);
