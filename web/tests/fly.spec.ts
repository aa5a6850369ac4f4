// A flight in the page: drawn, flown, and followed by what is judged.
import AxeBuilder from "@axe-core/playwright";
import { expect, test as plain, type Page } from "@playwright/test";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { hasVolume, open, openExample, plaza, plazaMesh, program, root, settled, test } from "./support";

const TABLE = "x,y,z,speed\n-40,-30,45,5\n40,-30,45,5\n40,40,60,5\n";
const file = join(plaza, "mission.yaml");

function checked(table = TABLE): { text: string; plan: string; check: any } {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  const plan = join(folder, "flight.csv");
  writeFileSync(plan, table);
  try {
    execFileSync(program, ["check", file, plan, "--heights", "scene", "--speed", "5", "-q", "-o", join(folder, "check.json")], { stdio: "pipe" });
  } catch (error) {
    expect((error as { status: number }).status).toBe(1); // not all that is asked for holds
  }
  const text = readFileSync(join(folder, "check.json"), "utf8");
  return { text, plan, check: JSON.parse(text) };
}

const flown = (page: Page) => page.evaluate(() => {
  const { flights } = (window as any).vantage;
  const { x, moment, ground, isPlaying, old } = flights;
  return { x, at: moment?.at as number[], seen: moment?.seen as number[], ground, isPlaying, old, sight: flights.view.sightCount as number, isShown: flights.view.isShown as boolean };
});

const flyTo = (page: Page, x: number) => page.locator("#fly").evaluate((slider: HTMLInputElement, value) => {
  slider.value = String(value);
  slider.dispatchEvent(new Event("input"));
}, x);

test.describe("a check that is dropped", () => {
  test.beforeEach(({ page }) => openExample(page));

  test("is drawn and flown", async ({ page }) => {
    const { text, check } = checked();
    await expect(page.locator("#flight")).toBeHidden();
    await open(page, { name: "check.json", text });
    await settled(page);
    await expect(page.locator("#flight-name")).toHaveText("check.json");
    await expect(page.locator("#flight-verdict")).toHaveText(check.passes ? "keeps what is asked" : "does not keep what is asked");
    const [{ begin_s, end_s, begin }] = check.targets[0].seen;
    // Where the target is seen lines of sight go to its corners; a little before none do.
    await flyTo(page, (begin_s + end_s) / 2);
    const corners = check.targets[0].parts.flat().length as number;
    expect((await flown(page)).sight).toBe(2 * corners);
    await expect(page.locator("#readout")).toContainText(`in view: ${check.targets[0].name}`);
    if (begin_s > 0.1) {
      await flyTo(page, begin_s - 0.01);
      expect((await flown(page)).seen).toEqual([]);
      expect((await flown(page)).sight).toBe(0);
      await expect(page.locator("#readout")).toContainText("no target in view");
      await flyTo(page, begin_s);
      for (const [i, key] of ["x_m", "y_m", "z_m"].entries()) expect((await flown(page)).at[i]).toBeCloseTo(begin[key], 6);
    }
    await flyTo(page, 0);
    await expect(page.locator("#readout")).toContainText("0.0 s · 0.0 m");
    expect((await flown(page)).ground).toBe(0);
    await expect(page.locator("#readout")).toContainText("45.0 m above ground, z 45.0 m");
    expect(await page.evaluate(() => (window as any).vantage.city.groundBelow([500, 0, 45]))).toBe(null); // beside the mesh
    // One strip for each target, one rectangle for each stretch.
    await expect(page.locator("#flight-rows .strip")).toHaveCount(check.targets.length);
    await expect(page.locator("#flight-rows .strip").first().locator(".seen")).toHaveCount(check.targets[0].seen.length);
  });

  test("tells of volumes and of links in their own words", async ({ page }) => {
    const { text, check } = checked();
    const [{ seen, parts }] = check.targets;
    const [{ begin_s, end_s }] = seen;
    expect(text).not.toContain('"volume"');
    check.targets = [{ name: "gate", volume: true, parts: [], seen }, { name: "yard", volume: true, parts: [], seen: [] }];
    check.links = [{ name: "pilot", linked: seen.slice(0, 1) }, { name: "mast", linked: [] }];
    await open(page, { name: "check.json", text: JSON.stringify(check) });
    await settled(page);
    const told = () => page.locator("#flight-rows .strip").evaluateAll((rows) => rows.map((row) => row.getAttribute("aria-label")!));
    const [gate, ...others] = await told();
    expect(gate).toContain("gate: inside from ");
    expect(others[0]).toBe("yard: nowhere inside");
    expect(others[1]).toMatch(/^link: pilot: holds from [\d.]+ to [\d.]+ s$/);
    expect(others[2]).toBe("link: mast: nowhere holds");
    await expect(page.locator("#flight-rows .linked")).toHaveCount(1);
    await flyTo(page, (begin_s + end_s) / 2);
    await expect(page.locator("#readout")).toContainText("inside: gate");
    await expect(page.locator("#readout")).not.toContainText("in view");
    await flyTo(page, begin_s / 2);
    await expect(page.locator("#readout")).toContainText("inside no volume");
    await expect(page.locator("#flight-volumes-label")).toBeHidden(); // the page has them not
    // Beside what is seen, and with lines of sight to that alone.
    check.targets.push({ name: "square", parts, seen });
    await open(page, { name: "check.json", text: JSON.stringify(check) });
    await settled(page);
    await flyTo(page, (begin_s + end_s) / 2);
    await expect(page.locator("#readout")).toContainText("in view: square · inside: gate");
    expect((await flown(page)).sight).toBe(2 * parts.flat().length);
  });

  test("the profile is over what lies below, not over what hangs above", async ({ page }) => {
    const bridge = plazaMesh.text + "o bridge\n" + [[-40, -31], [40, -31], [40, -29], [-40, -29]].map(([x, y]) => `v ${x} ${y} 50\n`).join("") + "f -4 -3 -2 -1\n";
    await open(page, { name: "bridge.obj", text: bridge }, { name: "check.json", text: checked().text });
    await settled(page);
    const gaps = await page.evaluate(() => {
      const { z, surface } = (window as any).vantage.flights.profile;
      return z.map((height: number, i: number) => height - surface[i]) as number[];
    });
    expect(Math.min(...gaps)).toBeGreaterThanOrEqual(0);
    expect(await page.evaluate(() => (window as any).vantage.city.surfaceBelow([[-20, -30, 55], [-20, -30, 45]]))).toEqual([50, 15]); // a roof
    // Under the ground the ground is told.
    expect(await page.evaluate(() => (window as any).vantage.city.surfaceBelow([[-20, -30, -3]]))).toEqual([0]);
    expect(await page.evaluate(() => (window as any).vantage.city.groundBelow([-20, -30, -3]))).toBe(0);
  });

  test("obeys the keyboard, and plays", async ({ page }) => {
    const { text, check } = checked();
    await open(page, { name: "check.json", text });
    await settled(page);
    await page.locator("#fly").focus();
    await page.keyboard.press("ArrowRight");
    expect((await flown(page)).x).toBeCloseTo(check.duration_s / 1000, 9);
    await page.keyboard.press("PageUp");
    expect((await flown(page)).x).toBeCloseTo((51 * check.duration_s) / 1000, 9);
    await page.keyboard.press("End");
    expect((await flown(page)).x).toBeCloseTo(check.duration_s, 9);
    await page.keyboard.press("Home");
    expect((await flown(page)).x).toBe(0);
    expect(await page.locator("#fly").getAttribute("aria-valuetext")).toContain("0.0 s");
    await page.locator("#play").focus();
    await page.keyboard.press("Enter");
    await expect(page.locator("#play")).toHaveText("Pause");
    await expect.poll(async () => (await flown(page)).x).toBeGreaterThan(0);
    await page.keyboard.press("Enter");
    await expect(page.locator("#play")).toHaveText("Play");
    const { x } = await flown(page);
    await page.waitForTimeout(200);
    expect((await flown(page)).x).toBe(x);
    await flyTo(page, check.duration_s - 0.01);
    await page.click("#play");
    await expect(page.locator("#play")).toHaveText("Play"); // it has ended
    expect((await flown(page)).x).toBeCloseTo(check.duration_s, 9);
  });

  test("is accessible, also in the dark and on a phone", async ({ page }) => {
    await open(page, { name: "check.json", text: checked().text });
    await settled(page);
    for (const isDark of [false, true]) {
      if (isDark) await page.click("#theme");
      const { violations } = await new AxeBuilder({ page }).analyze();
      expect(violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target).join(" ")}`)).toEqual([]);
    }
    await page.setViewportSize({ width: 390, height: 780 });
    expect(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth)).toBe(true);
  });

  test("costs nothing where it is wrong", async ({ page }) => {
    const { text, check } = checked();
    await open(page, { name: "check.json", text });
    await settled(page);
    await flyTo(page, 3);
    const before = await flown(page);
    const far = JSON.parse(text);
    for (const { position } of far.points) position.x_m += 50_000;
    const wrong: [string, string, string][] = [
      ["cut.json", text.slice(0, text.length / 2), "cut.json is cut short or damaged"],
      ["old.json", JSON.stringify({ ...check, points: check.points.map(({ at_m, arrival_s }: any) => ({ at_m, arrival_s })) }), 'old.json, points 1 has no "position"'],
      ["far.json", JSON.stringify(far), "away from the scene that is open"],
      ["flight.plan", "{}", "vantage view mission.yaml --flight flight.plan"],
    ];
    for (const [name, told, message] of wrong) {
      await open(page, { name, text: told });
      await expect(page.locator("#hint")).toContainText(message);
      expect(await flown(page), name).toEqual(before);
    }
    await expect(page.locator("#flight-name")).toHaveText("check.json");
    await page.click("#close-flight");
    await expect(page.locator("#flight")).toBeHidden();
    expect((await flown(page)).isShown).toBe(false);
  });

  test("goes with its scene", async ({ page }) => {
    const { text } = checked();
    const tent = "v 0 0 0\nv 10 0 0\nv 5 5 8\nv 5 -5 8\nf 1 2 3\nf 1 2 4\n";
    await open(page, { name: "check.json", text });
    await settled(page);
    await open(page, { name: "tent.obj", text: tent });
    await settled(page);
    await expect(page.locator("#flight")).toBeHidden();
    // Together with a scene it is opened in that one.
    await open(page, plazaMesh, { name: "check.json", text });
    await settled(page);
    await expect(page.locator("#flight")).toBeVisible();
  });
});

plain("a plan that the program was started with follows the mission", async ({ page }) => {
  const { plan, check } = checked();
  const viewer = spawn(program, ["view", file, "--flight", plan, "--heights", "scene", "--speed", "5", "--no-browser", "--page", join(root, "web/dist/index.html")]);
  try {
    await page.goto(await new Promise<string>((resolve) => viewer.stdout.once("data", (text: Buffer) => resolve(text.toString().trim()))));
    await hasVolume(page);
    await settled(page);
    const seen = () => page.evaluate(() => (window as any).vantage.flights.flight.targets[0].seen as number[][]);
    const [{ begin_s, end_s }] = check.targets[0].seen;
    expect((await seen())[0]).toEqual([begin_s, end_s]);
    await expect(page.locator("#flight-name")).toHaveText("flight.csv");
    expect((await flown(page)).old).toBe("");
    await flyTo(page, 4);
    const edit = (range: number) => page.evaluate((value) => (window as any).vantage.edit((m: any) => (m.maxRange = m.range = value), true), range);
    await edit(20); // nothing of the flight is so near
    await expect.poll(seen).toEqual([]);
    await expect(page.locator("#flight-verdict")).toHaveText("does not keep what is asked");
    await expect(page.locator("#flight-lines")).toContainText("nowhere seen whole");
    expect((await flown(page)).x).toBe(4);
    await page.click("#undo");
    await expect.poll(async () => (await seen())[0]).toEqual([begin_s, end_s]);
    await expect.poll(async () => (await flown(page)).old).toBe("");
    // A mission without a volume says that the flight is not judged by it.
    await page.evaluate(() => (window as any).vantage.edit((m: any) => (m.keepOut = [{ min: [1, 1, 1], max: [0, 0, 0] }]), true));
    await expect(page.locator("#flight-verdict")).toContainText("Not judged by this mission");
    expect((await flown(page)).isShown).toBe(true);
  } finally {
    viewer.kill("SIGINT");
  }
});

plain("of several targets each has a volume of its own", async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  writeFileSync(join(folder, "plaza.obj"), plazaMesh.text);
  writeFileSync(join(folder, "flight.csv"), TABLE);
  writeFileSync(join(folder, "several.yaml"), "scene: {mesh: plaza.obj}\nsensor: {max_range: 60}\ntargets:\n" +
    "  - {name: west, vertices: [[-40, -20, 0], [-36, -20, 0], [-36, -16, 0]]}\n  - {name: east, vertices: [[6, -6, 0], [9, -6, 0], [9, -3, 0]]}\n");
  const viewer = spawn(program, ["view", join(folder, "several.yaml"), "--flight", join(folder, "flight.csv"), "--heights", "scene", "--no-browser",
    "--page", join(root, "web/dist/index.html")]);
  try {
    await page.goto(await new Promise<string>((resolve) => viewer.stdout.once("data", (text: Buffer) => resolve(text.toString().trim()))));
    await hasVolume(page);
    await settled(page);
    await expect(page.locator("#flight-rows .strip")).toHaveCount(2);
    const drawn = () => page.evaluate(() => {
      const { mesh } = (window as any).vantage.flights.volumesView;
      return mesh.visible ? (mesh.geometry.getAttribute("position").count as number) : 0;
    });
    expect(await drawn()).toBe(0);
    await page.check("#flight-volumes");
    await expect.poll(drawn).toBeGreaterThan(100);
    const first = await drawn();
    await expect(page.locator("#flight-rows .row-name i")).toHaveCount(2);
    // They follow the mission, as the flight does.
    await page.evaluate(() => (window as any).vantage.edit((m: any) => (m.maxRange = m.range = 5), true));
    await expect.poll(async () => [0, first].includes(await drawn())).toBe(false);
    await page.uncheck("#flight-volumes");
    await expect.poll(drawn).toBe(0);
    await expect(page.locator("#flight-rows .row-name i")).toHaveCount(0);
  } finally {
    viewer.kill("SIGINT");
  }
});

plain("a mission of volumes to fly through has a flight and their volumes, and no volume of its own", async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  writeFileSync(join(folder, "plaza.obj"), plazaMesh.text);
  writeFileSync(join(folder, "flight.csv"), TABLE);
  const gate = "v -30 -35 40\nv -20 -35 40\nv -20 -25 40\nv -30 -25 40\nv -30 -35 50\nv -20 -35 50\nv -20 -25 50\nv -30 -25 50\n" +
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  writeFileSync(join(folder, "gate.obj"), gate);
  writeFileSync(join(folder, "through.yaml"), "scene: {mesh: plaza.obj}\ntargets: [{volume: gate.obj}]\nlinks: [{name: pilot, point: [-40, -60, 20]}]\n");
  const viewer = spawn(program, ["view", join(folder, "through.yaml"), "--flight", join(folder, "flight.csv"), "--heights", "scene", "--no-browser",
    "--page", join(root, "web/dist/index.html")]);
  try {
    await page.goto(await new Promise<string>((resolve) => viewer.stdout.once("data", (text: Buffer) => resolve(text.toString().trim()))));
    await settled(page);
    await expect(page.locator("#flight-verdict")).not.toContainText("Not judged");
    expect((await flown(page)).old).toBe("");
    await expect(page.locator("#hint")).toContainText("Play, or the slider");
    await expect(page.locator("#flight-rows .strip").first()).toHaveAttribute("aria-label", /^gate: inside from [\d.]+ to/);
    await expect(page.locator("#flight-rows .strip")).toHaveCount(2);
    const drawn = () => page.evaluate(() => {
      const { mesh } = (window as any).vantage.flights.volumesView;
      return mesh.visible ? (mesh.geometry.getAttribute("position").count as number) : 0;
    });
    await expect.poll(drawn).toBe(36);
    await page.uncheck("#flight-volumes");
    await expect.poll(drawn).toBe(0);
    await page.check("#flight-volumes");
    await expect.poll(drawn).toBe(36);
    // What is set without a target is no other mission, and one that has no volume is undone.
    const edit = (change: object) => page.evaluate((to) => (window as any).vantage.edit((m: any) => Object.assign(m, to), true), change);
    await edit({ maxRange: 40, range: 40 });
    expect((await flown(page)).old).toBe("");
    await edit({ target: { kind: "polygon", vertices: [[-40, -20, 0], [-36, -20, 0], [-36, -16, 0]] }, keepOut: [{ min: [1, 1, 1], max: [0, 0, 0] }] });
    await expect(page.locator("#flight-verdict")).toContainText("Not judged by this mission");
    await expect.poll(drawn).toBe(0);
    await page.click("#undo");
    await expect(page.locator("#flight-verdict")).not.toContainText("Not judged");
    await expect.poll(drawn).toBe(36);
    // A target that is drawn is another mission: it is judged by that, and once that is gone by none.
    await edit({ target: { kind: "polygon", vertices: [[-40, -20, 0], [-36, -20, 0], [-36, -16, 0]] } });
    await hasVolume(page);
    await expect(page.locator("#flight-rows .strip").first()).toHaveAttribute("aria-label", /^target: /);
    await expect.poll(drawn).toBe(0);
    await expect(page.locator("#flight-volumes-label")).toBeHidden();
    await page.click("#undo");
    await expect(page.locator("#flight-verdict")).toHaveText("Not judged by this mission: the mission has no target");
  } finally {
    viewer.kill("SIGINT");
  }
});
