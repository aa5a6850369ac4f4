// How quickly the volume follows a corner that is dragged, in real cities: in the page alone, and served by the program.
// Prints figures (bench/results); asserts only that there are answers.
import { expect, type Page } from "@playwright/test";
import { spawn } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { hasShared, hasVolume, onScreen, openExample, program, root, shared, test } from "./support";
import { test as plain } from "@playwright/test";

const cities = [
  { name: "Charlotte", file: "charlotte/uptownCharlotte.obj", up: "y",
    vertices: [[-346.654, -59.171, 1], [-369.28, -39.471, 1], [-340.906, -29.727, 1]] },
  { name: "Munich", file: "mesh/munich_merged.ply", up: "z",
    vertices: [[-5, -112, 0], [25, -112, 0], [22, -97, 0], [-8, -97, 0]] },
] as const;

const mesh = (file: string) => join(shared, "data", file);

/** Times in the page while a corner is dragged to and fro for four seconds. */
async function dragged(page: Page, corner: readonly number[], isDrawn = true): Promise<Record<string, number[]>> {
  await page.evaluate((draws) => {
    const { engine, stage } = (window as any).vantage;
    if (!draws) stage.request = () => {};
    const times: Record<string, number[]> = { engine: [], answer: [], frame: [], draw: [], task: [] };
    (window as any).times = times;
    const compute = engine.compute.bind(engine);
    engine.compute = async (text: string) => {
      const volume = await compute(text);
      if (volume) {
        times.engine!.push(volume.engine_ms);
        times.answer!.push(volume.total_ms);
      }
      return volume;
    };
    let last = performance.now();
    const onFrame = stage.onFrame;
    stage.onFrame = () => {
      const now = performance.now();
      times.frame!.push(now - last);
      times.draw!.push(stage.frame_ms);
      last = now;
      onFrame();
    };
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) times.task!.push(entry.duration);
    }).observe({ entryTypes: ["longtask"] });
  }, isDrawn);
  // Events of a mouse that tells its place 120 times a second: the driver's own ones wait for each picture.
  const at = await onScreen(page, corner);
  const perSecond = await page.evaluate(async ({ x, y }) => {
    const { canvas } = (window as any).vantage.stage;
    canvas.setPointerCapture = () => {};
    const tell = (kind: string, dx: number, dy: number) => canvas.dispatchEvent(
      new PointerEvent(kind, { clientX: x + dx, clientY: y + dy, button: 0, buttons: 1, pointerId: 1, bubbles: true }));
    tell("pointerdown", 0, 0);
    const start = performance.now();
    let moves = 0;
    await new Promise<void>((resolve) => {
      const timer = setInterval(() => {
        ++moves;
        tell("pointermove", 10 * Math.sin(moves / 40), 6 * Math.sin(moves / 31));
        if (performance.now() - start < 4000) return;
        clearInterval(timer);
        resolve();
      }, 8);
    });
    const seconds = (performance.now() - start) / 1000;
    tell("pointerup", 0, 0);
    return { answers: (window as any).times.answer.length / seconds, moves: moves / seconds };
  }, at);
  const times = (await page.evaluate(() => (window as any).times)) as Record<string, number[]>;
  return { ...times, perSecond: [perSecond.answers], moves: [perSecond.moves] };
}

function print(what: string, times: Record<string, number[]>): void {
  const at = (name: string, share: number) => {
    const sorted = [...times[name]!].sort((a, b) => a - b);
    return (sorted[Math.floor(share * (sorted.length - 1))] ?? 0).toFixed(1);
  };
  const both = (name: string) => `${name} ${at(name, 0.5)} / ${at(name, 0.95)}`;
  console.log(`${what}: ${at("perSecond", 0)} answers/s of ${at("moves", 0)} moves/s; median / 95 %, ms: ${both("engine")}, ` +
    `${both("answer")}, ${both("frame")}, ${both("draw")}; main-thread tasks over 50 ms: ${times.task!.length}, longest ${at("task", 1)}`);
}

test("the first picture with a volume", async ({ page }) => {
  await page.addInitScript(() => {
    const look = () => {
      if ((window as any).vantage?.volume && (window as any).vantage.stage.frame_ms > 0) (window as any).first = performance.now();
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  const times: number[] = [];
  for (let i = 0; i < 5; ++i) {
    await openExample(page);
    await page.waitForFunction(() => (window as any).first);
    times.push(await page.evaluate(() => (window as any).first as number));
    await page.goto("about:blank");
  }
  console.log(`first picture with a volume: ${times.map((time) => time.toFixed(0)).join(", ")} ms after the page was opened`);
});

test.describe("in the page", () => {
  test.skip(!hasShared, "set VANTAGE_SHARED to the folder that holds data/");
  for (const { name, file, up, vertices } of cities) {
    test(name, async ({ page }) => {
      await openExample(page);
      await page.selectOption("#up", up);
      const start = Date.now();
      await page.setInputFiles("#file", mesh(file));
      await page.waitForFunction((n) => (window as any).vantage.source.name === n, file.split("/").pop());
      await page.evaluate((corners) => {
        const app = (window as any).vantage;
        app.edit((m: any) => {
          m.range = 300;
          m.target = { kind: "polygon", vertices: corners };
        }, true);
      }, vertices as unknown as number[][]);
      await hasVolume(page);
      const first = Date.now() - start;
      await page.evaluate(() => (window as any).vantage.lookAtTarget());
      await page.waitForTimeout(500);
      const times = await dragged(page, vertices[0]);
      print(`${name} in the page, ${first} ms from the file to the first volume`, times);
      print(`${name} in the page, not drawn`, await dragged(page, vertices[0], false));
      expect(times.answer!.length).toBeGreaterThan(0);
    });
  }
});

/** A camera that turns, a band of heights above the ground, and a zone that the target lies beside. */
function limits(corner: readonly number[]): string {
  const [x, y] = [corner[0]! + 20, corner[1]!];
  const zone = [[x, y - 60], [x + 130, y - 60], [x + 130, y + 60], [x, y + 60]];
  return ", camera: {width: 4000, height: 3000}, fov: [70, 55], gimbal: {pitch: [-90, 20]}}\n" +
    `navigation: {altitude: {agl: [20, 120]}, ground: 0, keep_out: [{polygon: ${JSON.stringify(zone)}, z: [0, 200]}]}\n`;
}

plain.describe("served", () => {
  plain.skip(!hasShared, "set VANTAGE_SHARED to the folder that holds data/");
  for (const { name, file, up, vertices } of cities) {
    for (const [kind, more] of [["", "}\n"], [" with a camera, heights and a zone", limits(vertices[0])]] as const) {
      plain(name + kind, async ({ page }) => {
        const mission = join(mkdtempSync(join(tmpdir(), "vantage-")), "mission.yaml");
        writeFileSync(mission, `scene: {mesh: ${mesh(file)}, up: ${up}}\ntarget:\n  vertices: ${JSON.stringify(vertices)}\n` +
          `sensor: {max_range: 300${more}`);
        const server = spawn(program, ["view", mission, "--no-browser", "--page", join(root, "web/dist/index.html")]);
        try {
          const address = await new Promise<string>((resolve) => server.stdout.once("data", (text: Buffer) => resolve(text.toString().trim())));
          await page.goto(address);
          await hasVolume(page);
          await page.waitForTimeout(500);
          const times = await dragged(page, vertices[0]);
          print(`${name}${kind} served`, times);
          print(`${name}${kind} served, not drawn`, await dragged(page, vertices[0], false));
          expect(times.answer!.length).toBeGreaterThan(0);
        } finally {
          server.kill("SIGINT");
        }
      });
    }
  }
});
