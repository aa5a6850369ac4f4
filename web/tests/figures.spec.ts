// How quickly the volume follows, in real cities. Prints figures; asserts only that there are answers.
import { expect } from "@playwright/test";
import { join } from "node:path";
import { hasShared, openExample, shared, test } from "./support";

test.describe("real cities", () => {
  const shared = process.env.VANTAGE_SHARED ?? resolve(root, "../shared");
  test.skip(!existsSync(join(shared, "data")), "set VANTAGE_SHARED to the folder that holds data/");
  for (const [name, file, up, corners] of [
    ["Charlotte", "charlotte/uptownCharlotte.obj", "y", [[-346.654, -59.171, 1], [-369.28, -39.471, 1], [-340.906, -29.727, 1]]],
    ["Munich", "mesh/munich_merged.ply", "z", [[-5, -112, 0], [25, -112, 0], [22, -97, 0], [-8, -97, 0]]],
  ] as const) {
    test(`${name} answers while a corner is dragged`, async ({ page }) => {
      await page.selectOption("#up", up);
      await page.setInputFiles("#file", join(shared, "data", file));
      await page.waitForFunction((n) => (window as any).vantage.source.name === n, file.split("/").pop());
      const times = await page.evaluate(async (vertices) => {
        const app = (window as any).vantage;
        const all: number[][] = [];
        for (let i = 0; i < 40; ++i) {
          const moved = vertices.map((v, k) => (k === 0 ? [v[0]! + 0.1 * i, v[1]!, v[2]!] : [...v]));
          app.mission.range = 300;
          app.mission.target = { kind: "polygon", vertices: moved };
          const text = `target:\n  vertices: ${JSON.stringify(moved)}\nsensor:\n  max_range: 300\n`;
          const v = await app.engine.compute(text);
          const start = performance.now();
          app.volumeView.show(v.info, v.mesh);
          const shown = performance.now() - start;
          app.stage.renderer.render(app.stage.scene, app.stage.camera);
          all.push([v.info.resolve_ms + v.info.compute_ms, v.total_ms, shown, performance.now() - start - shown]);
        }
        return all;
      }, corners as unknown as number[][]);
      const at = (column: number, share: number) =>
        times.map((row) => row[column]!).sort((a, b) => a - b)[Math.floor(share * (times.length - 1))]!.toFixed(1);
      console.log(`${name}, median and 95 %, ms: engine ${at(0, 0.5)}, ${at(0, 0.95)}; answer ${at(1, 0.5)}, ${at(1, 0.95)}; ` +
        `geometry ${at(2, 0.5)}, ${at(2, 0.95)}; frame ${at(3, 0.5)}, ${at(3, 0.95)}`);
      expect(times).toHaveLength(40);
    });
  }
});
