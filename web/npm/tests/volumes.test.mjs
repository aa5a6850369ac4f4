// The package in Node.js beside the program: the same bytes.
//   VANTAGE: the program; VANTAGE_SHARED: the folder that holds data/
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { before, describe, test } from "node:test";
import { Engine, VantageError, compute } from "vantage-engine";
import { byProgram, noProgram, plaza, root, shared } from "./support.mjs";

let engine;
before(async () => { engine = await Engine.create(); });

const square = "target: {vertices: [[2, 3, 0], [7, 3, 0], [7, 8, 0], [2, 8, 0]]}\n";
const missions = {
  "range": "sensor: {max_range: 60}\n",
  "gimbal": "sensor: {max_range: 60, fov: [60, 40]}\n",
  "camera that turns": "sensor: {max_range: 60, fov: [60, 40], mount: {yaw: any, pitch: -60}}\n",
  "sun": "sensor: {max_range: 60, sun: {azimuth: 200, elevation: 30, exclude: 20}}\n",
  "share": "sensor: {max_range: 60, visible: 0.5, cells: 6}\n",
  "clearance": "sensor: {max_range: 60}\nnavigation: {clearance: 2, altitude: [2, 50]}\n",
  "zones": "sensor: {max_range: 60}\nnavigation: {keep_out: [{min: [-20, -20, 5], max: [10, 10, 20]}]}\n",
};
const cities = [
  [join(shared, "data/charlotte/uptownCharlotte.obj"), "  up: y\n",
   "target: {vertices: [[-346.654, -59.171, 1], [-369.28, -39.471, 1], [-340.906, -29.727, 1]]}\nsensor: {max_range: 300}\n"],
  [join(shared, "data/mesh/munich_merged.ply"), "",
   "target: {vertices: [[-5, -112, 0.05], [10, -112, 0.05], [10, -97, 0.05], [-5, -97, 0.05]]}\nsensor: {max_range: 300}\n"],
];

function assertSame(mesh, mission) {
  const calls = [];
  const volume = engine.compute(mission, { [basename(mesh)]: readFileSync(mesh) }, { onProgress: (...told) => { calls.push(told); } });
  assert.equal(volume.outcome, "computed");
  assert.ok(calls.length > 0 && calls.every(([, fraction]) => fraction >= 0 && fraction <= 1));
  assert.ok(Buffer.from(volume.save("ply")).equals(byProgram(mission, mesh)));
  volume.release();
}

describe("limits", { skip: noProgram }, () => {
  for (const [name, limits] of Object.entries(missions)) {
    test(name, () => assertSame(plaza, `scene: {mesh: plaza.obj}\n${square}${limits}`));
  }
});

for (const [mesh, keys, body] of cities) {
  test(basename(mesh), { skip: noProgram || (existsSync(mesh) ? false : "set VANTAGE_SHARED to the folder that holds data/") },
       () => assertSame(mesh, `scene:\n  mesh: ${basename(mesh)}\n${keys}${body}`));
}

test("the example's arrays, report, answers and proof", async () => {
  const mission = readFileSync(join(root, "examples/plaza/mission.yaml"), "utf8");
  const volume = await compute(mission, { "plaza.obj": readFileSync(plaza, "utf8") });
  assert.equal(volume.faces.length, 3 * volume.causeOf.length);
  assert.ok(volume.faces.every((corner) => 3 * corner < volume.vertices.length));
  assert.ok(volume.causeOf.every((cause) => cause < volume.causes.length));
  assert.equal(volume.report.facets ?? volume.causeOf.length, volume.causeOf.length);
  const answers = volume.query([0, 0, 30, 40, 0, 45]);
  assert.deepEqual([...answers.inside], [1, 0]);
  assert.deepEqual(answers.blockedBy, [[], ["church_tower"]]);
  assert.equal(volume.prove().verdict, "proved");
  for (const format of engine.formats()) assert.ok(volume.save(format).length > 0);
  volume.release();
  assert.throws(() => volume.save());
});

test("errors have a code and a place", () => {
  const bad = (mission, files, code) => assert.throws(() => engine.compute(mission, files), (error) => {
    assert.ok(error instanceof VantageError);
    assert.equal(error.code, code);
    assert.ok(!`${error.where}${error.problem}`.includes("/job"));
    return true;
  });
  bad(`scene: {mesh: none.obj}\n${square}sensor: {max_range: 60}\n`, {}, "file-not-found");
  bad(`scene: {osm: town.osm}\n${square}sensor: {max_range: 60}\n`, { "town.osm": "<osm/>" }, "component-missing");
  bad("scene: [", {}, "yaml-syntax");
  bad("", { "../x": "" }, "value-syntax");
});

test("a function of progress stops the work, and what it throws comes through", () => {
  const ask = (onProgress) => engine.compute(`scene: {mesh: plaza.obj}\n${square}sensor: {max_range: 60}\n`, { "plaza.obj": readFileSync(plaza) },
                                             { onProgress });
  assert.throws(() => ask(() => false), { kind: "cancelled" });
  assert.throws(() => ask(() => { throw new RangeError(); }), RangeError);
  assert.equal(ask(() => undefined).outcome, "computed");
});
