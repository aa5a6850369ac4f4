// Limits as files have them: each control sets its own key, and an end that is open is none.
import { expect, type Page } from "@playwright/test";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { byProgram, drag, mission, onScreen, open, openExample, plaza, savedMission, settled, test, volume } from "./support";

test.beforeEach(({ page }) => openExample(page));

const mesh = { name: "plaza.obj", text: readFileSync(join(plaza, "plaza.obj"), "utf8") };
const square = "vertices: [[-8, -8, 0], [4, -8, 0], [4, 3, 0], [-8, 3, 0]]";
const camera = "camera: {model: sony_a7r_iv_35mm}";

/** A mission in the plaza. */
const openMission = (page: Page, text: string) => reopen(page, `scene: {mesh: plaza.obj}\n${text}`);

/** Until the panel is drawn, too: a key moves a slider from where it stands. */
async function drawn(page: Page): Promise<void> {
  await settled(page);
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

/** Until it is there: the page may show the same mission already. */
async function reopen(page: Page, text: string): Promise<void> {
  const before = await page.evaluateHandle(() => (window as any).vantage.mission.opened);
  await open(page, { name: "m.yaml", text }, mesh);
  await expect.poll(() => page.evaluate((old) => {
    const { mission, volume } = (window as any).vantage;
    return mission.written !== "" && mission.opened !== old && Boolean(volume);
  }, before)).toBe(true);
  await drawn(page);
}

const opened = (page: Page, sensor: string, navigation = "{}") =>
  openMission(page, `target: {${square}}\nsensor: {${sensor}}\nnavigation: ${navigation}\n`);

async function type(page: Page, id: string, text: string): Promise<void> {
  await page.locator(`#${id}-number`).fill(text);
  await page.locator(`#${id}-number`).press("Enter");
  await drawn(page);
}

const heights = (page: Page) => page.evaluate(() => (window as any).vantage.volumeView.heights() as [number, number]);

const failure = (page: Page) => page.evaluate(() => (window as any).vantage.failure as string);

/** With the program: surfaces that approximate the same round ones differ by the tolerance at most, 1 cm here. */
async function agrees(page: Page): Promise<string> {
  expect(await failure(page)).toBe("");
  const text = await savedMission(page);
  const area = await page.evaluate(() => (window as any).vantage.volume.info.area_m2 as number);
  expect(Math.abs((await volume(page)) - byProgram(text))).toBeLessThan(0.01 * area);
  return text;
}

test("a mission that begins with three dashes is saved as one document", async ({ page }) => {
  const text = `---\n# the square\nscene: {mesh: plaza.obj}\ntarget: {${square}}\nsensor: {max_range: 60}\n`;
  await reopen(page, text);
  await type(page, "range", "50");
  const saved = await agrees(page);
  expect(saved).toContain("# the square");
  await reopen(page, saved);
  expect((await mission(page)).range).toBe(50);
});

test("the page says what is claimed of the volume", async ({ page }) => {
  const claim = (visible: number, combine: string) => page.evaluate((made) => {
    const app = (window as any).vantage;
    app.volume.info.claim = made;
    app.changed();
    app.setProbe([0, 0, 30]);
  }, { visible, combine });
  await expect(page.locator("footer")).toContainText("sees all of the target");
  for (const [visible, combine, text] of [
    [0.5, "all", "at least 50 % of the target"], [1, "any", "all of at least one of the targets"],
    [0.8, "any", "at least 80 % of at least one of the targets"], [1, "all", "all of the target"],
  ] as const) {
    await claim(visible, combine);
    await expect(page.locator("footer")).toContainText(`sees ${text}.`);
    await expect(page.locator("#hint")).toContainText(`Inside: this position sees ${text}`);
  }
  await claim(0.5, "all");
  await page.click("#prove");
  await expect(page.locator("#proof")).toContainText("sees at least 50 % of the target");
});
