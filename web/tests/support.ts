// The page in a real browser, opened from the disk.
import { expect, test as base, type Page } from "@playwright/test";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

export const root = fileURLToPath(new URL("../..", import.meta.url));
export const page_url = pathToFileURL(join(root, "web/dist/index.html")).href;
export const program = process.env.VANTAGE ?? join(root, "build/bin/vantage");
export const plaza = join(root, "examples/plaza");
export const plazaMesh = { name: "plaza.obj", text: readFileSync(join(plaza, "plaza.obj"), "utf8") };
export const shared = process.env.VANTAGE_SHARED ?? resolve(root, "../shared");
export const hasShared = existsSync(join(shared, "data"));

/** No test may end with an error in the console, or have asked another host for anything. */
export const test = base.extend({
  page: async ({ page }, use) => {
    const problems: string[] = [];
    page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => {
      if (!/^(file|blob|data):/.test(request.url())) problems.push(`asks ${request.url()}`);
    });
    await use(page);
    expect(problems).toEqual([]);
  },
});

export async function openExample(page: Page): Promise<void> {
  await page.goto(page_url);
  await hasVolume(page);
}

/** Without waitForFunction: the policy of a served page allows no eval. */
export const hasVolume = (page: Page): Promise<void> =>
  expect.poll(() => page.evaluate(() => Boolean((window as any).vantage?.volume)), { timeout: 30_000 }).toBe(true);

/** Cubic metres. */
export const volume = (page: Page): Promise<number> => page.evaluate(() => (window as any).vantage.volume.info.volume_m3);

export const mission = (page: Page) => page.evaluate(() => JSON.parse(JSON.stringify((window as any).vantage.mission)));

/** Where a place of the scene is on the screen. */
export const onScreen = (page: Page, at: readonly number[]): Promise<{ x: number; y: number }> =>
  page.evaluate((p) => {
    const { stage, city } = (window as any).vantage;
    const { x, y } = stage.project(city.toView(p));
    const box = stage.canvas.getBoundingClientRect();
    return { x: box.left + x, y: box.top + y };
  }, at);

/** Until nothing is opened or computed any more. */
export const settled = (page: Page): Promise<void> =>
  expect.poll(() => page.evaluate(() => document.body.ariaBusy === "false" && (window as any).vantage.engine.isIdle), { timeout: 30_000 })
    .toBe(true);

/** Facets without end take longer to draw in software than to compute. */
export const hideVolume = (page: Page): Promise<void> => page.evaluate(() => (window as any).vantage.volumeView.setVisible(false));

export async function drag(page: Page, from: readonly number[], by: { x: number; y: number }): Promise<void> {
  const { x, y } = await onScreen(page, from);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 8; ++i) await page.mouse.move(x + (by.x * i) / 8, y + (by.y * i) / 8);
  await page.mouse.up();
  await settled(page);
}

/** What the program computes of the mission that the page would save. */
export function byProgram(text: string): number {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  writeFileSync(join(folder, "plaza.obj"), readFileSync(join(plaza, "plaza.obj")));
  writeFileSync(join(folder, "mission.yaml"), text);
  const report = execFileSync(program, ["compute", join(folder, "mission.yaml"), "-o", join(folder, "v.ply"), "--json", "-q"]);
  return JSON.parse(report.toString()).volume_m3 as number;
}

/** The file of a format that the page saves. */
export async function saved(page: Page, format: string): Promise<string> {
  await page.selectOption("#format", format);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
  return (await download.path())!;
}

export const savedMission = async (page: Page) => readFileSync(await saved(page, "mission"), "utf8");

/** That the program computes the same volume of the mission that the page saves, whose text this is. */
export async function agrees(page: Page): Promise<string> {
  expect(await page.evaluate(() => (window as any).vantage.failure as string)).toBe("");
  const text = await savedMission(page);
  const [own, other] = [await volume(page), byProgram(text)];
  expect(Math.abs(own - other)).toBeLessThanOrEqual(1e-12 * other);
  return text;
}

/** Opens files as if they were dropped. */
export const open = (page: Page, ...files: { name: string; text: string }[]) =>
  page.setInputFiles("#file", files.map(({ name, text }) => ({ name, mimeType: "text/plain", buffer: Buffer.from(text) })));

/** What the button puts into the clipboard. */
export async function copiedLink(page: Page): Promise<string> {
  await page.evaluate(() => (navigator.clipboard.writeText = async (text) => void ((window as any).copied = text)));
  await page.click("#link");
  await expect(page.locator("#hint")).toContainText("link is copied");
  return page.evaluate(() => (window as any).copied as string);
}
