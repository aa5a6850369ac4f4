// The engine of the page beside the program: the volumes have the same bytes, of ten targets, which both prove, and
// with all kinds of limits.
//   VANTAGE: the program; VANTAGE_ENGINE: the folder with vantage.js; VANTAGE_SHARED: the folder that holds data/
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../..", import.meta.url));
const program = process.env.VANTAGE ?? join(root, "build/bin/vantage");
const engineFolder = resolve(process.env.VANTAGE_ENGINE ?? join(root, "build-web"));
const shared = process.env.VANTAGE_SHARED ?? resolve(root, "../shared");

const square = (x, y, z, side) => [[x, y, z], [x + side, y, z], [x + side, y + side, z], [x, y + side, z]];
const scenes = [
  { name: "plaza", mesh: join(root, "examples/plaza/plaza.obj"), keys: "", range: 70, targets: [
    square(-8, -8, 0, 12), square(2, 3, 0, 5), [[-6, -6, 0], [9, -4, 0], [0, 7, 0]],
  ] },
  { name: "charlotte", mesh: join(shared, "data/charlotte/uptownCharlotte.obj"), keys: "\n  up: y", range: 300, targets: [
    [[-346.654, -59.171, 1], [-369.28, -39.471, 1], [-340.906, -29.727, 1]], square(-355, -52, 1, 6),
    square(0, 0, 150, 10), square(-345, -50, 2, 3),
  ] },
  { name: "munich", mesh: join(shared, "data/mesh/munich_merged.ply"), keys: "", range: 300, targets: [
    square(-5, -112, 0.05, 15), square(5, -108, 1, 4), [[-5, -112, 0], [25, -112, 0], [22, -97, 0], [-8, -97, 0]],
  ] },
];

let engine;
let folder;
const call = (name, ...values) => {
  const types = values.map((value) => (typeof value === "string" ? "string" : "number"));
  const answer = JSON.parse(engine.ccall(`vantage_${name}`, "string", types, values));
  if (answer.error) throw new Error(JSON.stringify(answer.error));
  return answer;
};
/** The last volume as a file. */
const saved = (format) => {
  const { size } = call("save", format);
  const at = engine.ccall("vantage_bytes", "number", [], []) >>> 0;
  return Buffer.from(engine.HEAPU8.slice(at, at + size));
};
const run = (...words) => execFileSync(program, words, { encoding: "utf8" });

before(async () => {
  const create = createRequire(import.meta.url)(join(engineFolder, "vantage.js"));
  engine = await create({ wasmBinary: readFileSync(join(engineFolder, "vantage.wasm")) });
  folder = mkdtempSync(join(tmpdir(), "vantage-"));
});
after(() => folder && rmSync(folder, { recursive: true }));

// Of one mission, by the engine here and by the program.
function volumes(body, mesh, keys) {
  const mission = join(folder, "mission.yaml"), native = join(folder, "native.ply"), here = join(folder, "web.ply");
  writeFileSync(mission, `scene:\n  mesh: ${mesh}${keys}\n${body}`);
  run("compute", mission, "-o", native, "-q");
  const info = call("compute", body);
  assert.equal(info.outcome, "computed");
  writeFileSync(here, saved("ply"));
  return { info, mission, native, here };
}

function assertSame({ native, here }) {
  if (readFileSync(here).equals(readFileSync(native))) return;
  const judged = JSON.parse(run("compare", here, native, "--json", "-q"));
  const worst = Math.max(...["a", "b"].map((side) => judged[`worst_only_${side}_bound_m`]));
  assert.fail(`other bytes, and the surfaces are up to ${worst} m apart`);
}

function open(mesh, keys) {
  engine.FS.writeFile(basename(mesh), readFileSync(mesh));
  call("open", `scene:\n  mesh: ${basename(mesh)}${keys}\n`);
}

for (const { name, mesh, keys, range, targets } of scenes) {
  describe(name, { skip: existsSync(mesh) ? false : "set VANTAGE_SHARED to the folder that holds data/" }, () => {
    before(() => open(mesh, keys));
    targets.forEach((vertices, i) => test(`target ${i + 1}`, () => {
      const target = `target: {vertices: ${JSON.stringify(vertices)}}`;
      const both = volumes(`${target}\nsensor: {max_range: ${range}}\n`, mesh, keys);
      assertSame(both);
      assert.equal(call("prove").verdict, "proved");
      assert.equal(JSON.parse(run("prove", both.mission, both.native, "--json", "-q")).verdict, "proved");
      console.log(`${name} ${i + 1}: ${both.info.facets} facets, same bytes`);
    }));
  });
}

// What cuts volumes, joins them, or turns the camera.
describe("limits", () => {
  const { mesh, keys, targets } = scenes[0];
  const polygon = `vertices: ${JSON.stringify(targets[1])}`;
  const camera = "camera: {width: 4000, height: 3000, focal_length: 8.8, sensor_width: 13.2}";
  const missions = {
    "several parts": [`parts: ${JSON.stringify([targets[1], square(4, 5, 6, 3)])}`, ""],
    "a point, with a radio link": ["point: [4, 5, 6]", "link: {frequency: 2.4}"],
    "a slant and a least range": [polygon, "incidence: 60, min_range: 15"],
    "a gimbal": [polygon, "fov: [60, 40]"],
    "a camera that turns": [polygon, "fov: [60, 40], mount: {yaw: any, pitch: -60}"],
    "a camera that does not": [polygon, "fov: [70, 50], mount: {yaw: 30, pitch: -50, roll: 5}"],
    "a pixel and the sun": [polygon, `${camera}, pixel: {size: 0.02}, sun: {azimuth: 200, elevation: 30, exclude: 20}`],
    "most of the target": [polygon, "visible: 0.5, cells: 6"],
    "a clearance and a band of heights": [polygon, "", "clearance: 2, altitude: [2, 50]"],
    "zones": [polygon, "", "keep_out: [{min: [-20, -20, 5], max: [10, 10, 20]}], " +
              "keep_in: [{polygon: [[-60, -50], [40, -55], [50, 30], [0, 10]], z: [3, 90]}]"],
  };
  before(() => open(mesh, keys));
  for (const [name, [target, sensor, navigation = ""]] of Object.entries(missions)) {
    test(name, () => {
      const sensors = `{max_range: 60${sensor ? `, ${sensor}` : ""}}`;
      assertSame(volumes(`target: {${target}}\nsensor: ${sensors}\nnavigation: {${navigation}}\n`, mesh, keys));
    });
  }
});
