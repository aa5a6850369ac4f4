// The engine of the page beside the program: ten targets, surfaces that differ by the tolerance at most, both proved.
//   VANTAGE: the program; VANTAGE_ENGINE: the folder with vantage.js; VANTAGE_SHARED: the folder that holds data/
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../..", import.meta.url));
const program = process.env.VANTAGE ?? join(root, "build/bin/vantage");
const engineFolder = resolve(process.env.VANTAGE_ENGINE ?? join(root, "build-web"));
const shared = process.env.VANTAGE_SHARED ?? resolve(root, "../shared");

const square = (x, y, z, side) => [[x, y, z], [x + side, y, z], [x + side, y + side, z], [x, y + side, z]];
const scenes = [
  { name: "plaza", mesh: join(root, "examples/plaza/plaza.obj"), keys: "", range: 70, tolerance: 0.01, targets: [
    square(-8, -8, 0, 12), square(2, 3, 0, 5), [[-6, -6, 0], [9, -4, 0], [0, 7, 0]],
  ] },
  { name: "charlotte", mesh: join(shared, "data/charlotte/uptownCharlotte.obj"), keys: "\n  up: y", range: 300, tolerance: 0.01, targets: [
    [[-346.654, -59.171, 1], [-369.28, -39.471, 1], [-340.906, -29.727, 1]], square(-355, -52, 1, 6), square(0, 0, 150, 10),
    square(-345, -50, 2, 3),
  ] },
  { name: "munich", mesh: join(shared, "data/mesh/munich_merged.ply"), keys: "", range: 300, tolerance: 0.01, targets: [
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

for (const { name, mesh, keys, range, tolerance, targets } of scenes) {
  describe(name, { skip: existsSync(mesh) ? false : "set VANTAGE_SHARED to the folder that holds data/" }, () => {
    const extension = mesh.slice(mesh.lastIndexOf("."));
    before(() => {
      engine.FS.writeFile(`scene${extension}`, readFileSync(mesh));
      call("open", `scene:\n  mesh: scene${extension}${keys}\n`);
    });
    targets.forEach((vertices, i) => test(`target ${i + 1}`, () => {
      const body = `target:\n  vertices: ${JSON.stringify(vertices)}\nsensor:\n  max_range: ${range}\n`;
      const mission = join(folder, "mission.yaml");
      writeFileSync(mission, `scene:\n  mesh: ${mesh}${keys}\n${body}`);
      const native = join(folder, "native.ply");
      run("compute", mission, "-o", native, "-q");

      const here = join(folder, "web.ply");
      const info = call("compute", body);
      assert.equal(info.outcome, "computed");
      writeFileSync(here, saved("ply"));
      const judged = JSON.parse(run("compare", here, native, "--json", "-q"));
      const worst = Math.max(...["a", "b"].map((side) => judged[`worst_only_${side}_m`]));
      assert.ok(worst <= tolerance, `the surfaces are ${worst} m apart: ${JSON.stringify(judged)}`);
      assert.equal(call("prove").verdict, "proved");
      assert.equal(JSON.parse(run("prove", mission, native, "--json", "-q")).verdict, "proved");
      const isSame = readFileSync(here).equals(readFileSync(native));
      console.log(`${name} ${i + 1}: ${info.facets} facets, worst distance ${worst} m, ${isSame ? "same bytes" : "other bytes"}`);
    }));
  });
}
