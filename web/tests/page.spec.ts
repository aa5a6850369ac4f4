// What the page shows, takes and gives.
import AxeBuilder from "@axe-core/playwright";
import { expect } from "@playwright/test";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import {
  byProgram, copiedLink, drag, mission, onScreen, open, openExample, page_url, plaza, saved, savedMission, settled, test, volume,
} from "./support";

test.beforeEach(({ page }) => openExample(page));

test("shows the example's volume, as the program computes it", async ({ page }) => {
  const report = byProgram(readFileSync(join(plaza, "mission.yaml"), "utf8"));
  expect(Math.abs((await volume(page)) / report - 1)).toBeLessThan(1e-9);
  await expect(page.locator("#legend li")).not.toHaveCount(0);
});

test("the volume follows a corner that is dragged, and undo brings it back", async ({ page }) => {
  const before = await volume(page);
  const { target } = await mission(page);
  await drag(page, target.vertices[0], { x: 24, y: -16 });
  const after = await volume(page);
  expect(after).not.toBe(before);
  const text = await savedMission(page);
  expect(Math.abs(after / byProgram(text) - 1)).toBeLessThan(1e-9);
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await volume(page)).toBe(before);
  await page.keyboard.press("Control+y");
  await settled(page);
  expect(await volume(page)).toBe(after);
});

test("a target is drawn by clicks", async ({ page }) => {
  await page.keyboard.press("d");
  for (const at of [[-6, -6, 0], [6, -6, 0], [6, 5, 0], [-6, 5, 0]]) {
    const { x, y } = await onScreen(page, at);
    await page.mouse.click(x, y);
  }
  await page.keyboard.press("Enter");
  await settled(page);
  const { target } = await mission(page);
  expect(target.vertices).toHaveLength(4);
  for (const corner of target.vertices) expect(Math.abs(corner[2])).toBeLessThan(1e-3);
  expect(await volume(page)).toBeGreaterThan(0);
});

test("a corner that is not convex is said, and the last volume stays", async ({ page }) => {
  const before = await volume(page);
  await page.evaluate(() => (window as any).vantage.edit(
    (m: any) => (m.target = { kind: "polygon", vertices: [[-9, -9, 0], [9, -9, 0], [0, -6, 0], [-9, 9, 0]] }), true));
  await expect(page.locator("#hint")).toContainText("not convex");
  expect(await volume(page)).toBe(before);
});

test("the range slider limits the volume", async ({ page }) => {
  const before = await volume(page);
  await page.locator("#range").fill("40");
  await settled(page);
  expect(await volume(page)).toBeLessThan(before);
});

test("a probe says what hides the target", async ({ page }) => {
  await page.evaluate(() => (window as any).vantage.setProbe([-2, -45, 12]));
  await expect(page.locator("#hint")).toContainText("hidden by");
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  await expect(page.locator("#hint")).toContainText("Inside");
  await page.click("#see");
  const eye = await page.evaluate(() => (window as any).vantage.stage.camera.position.z + (window as any).vantage.scene.origin[2]);
  expect(eye).toBeCloseTo(30, 6);
});

test("the volume is proved, cut and saved", async ({ page }) => {
  await page.click("#prove");
  await expect(page.locator("#proof")).toContainText("Proved");
  await page.locator("#cut").fill("20");
  await expect(page.locator("#cut-out")).toContainText("20 m, ");
  for (const format of ["ply", "glb", "stl", "picture"]) {
    expect(readFileSync(await saved(page, format)).length).toBeGreaterThan(1000);
  }
});

test("meshes and missions are opened, and bad ones lose nothing", async ({ page }) => {
  const before = await volume(page);
  await page.setInputFiles("#file", { name: "broken.obj", mimeType: "text/plain", buffer: Buffer.from("v 0 0\nf 1 2 3\n") });
  await expect(page.locator("#hint")).toHaveClass("bad");
  expect(await volume(page)).toBe(before);
  await page.setInputFiles("#file", { name: "empty.ply", mimeType: "text/plain", buffer: Buffer.from("") });
  await expect(page.locator("#hint")).toHaveClass("bad");
  await page.setInputFiles("#file", { name: "other.yaml", mimeType: "text/plain", buffer: Buffer.from("scene: {mesh: other.obj}\n") });
  await expect(page.locator("#hint")).toContainText("other.obj");
  expect(await volume(page)).toBe(before);
  await page.setInputFiles("#file", [join(plaza, "plaza.obj"), join(plaza, "mission.yaml")]);
  await page.waitForFunction(() => (window as any).vantage.scene.read_ms >= 0 && (window as any).vantage.volume);
  await settled(page);
  expect(await volume(page)).toBe(before);
});

test("a link holds the mission, and one that is cut short is said", async ({ page }) => {
  await page.locator("#range").fill("50");
  await settled(page);
  const range = await volume(page);
  const link = await copiedLink(page);
  await page.locator("#range").fill("30");
  await settled(page);
  await page.goto(link); // no page is loaded: only what follows the # differs
  await expect.poll(async () => (await mission(page)).range).toBe(50);
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForFunction(() => (window as any).vantage?.mission.range === 50 && (window as any).vantage.volume);
  await settled(page);
  expect(await volume(page)).toBe(range);
  await page.goto("about:blank");
  await page.goto(link.slice(0, -12));
  await expect(page.locator("#hint")).toContainText("cut short");
});

test("is accessible, also in the dark and on a phone", async ({ page }) => {
  for (const isDark of [false, true]) {
    if (isDark) await page.click("#theme");
    const { violations } = await new AxeBuilder({ page }).analyze();
    expect(violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target).join(" ")}`)).toEqual([]);
  }
  await page.setViewportSize({ width: 390, height: 780 });
  await expect(page.locator("#canvas")).toBeVisible();
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth)).toBe(true);
});
