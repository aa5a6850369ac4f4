// Limits as files have them: each control sets its own key, and an end that is open is none.
import { expect, type Page } from "@playwright/test";
import { agrees, drag, mission, onScreen, open, openExample, plazaMesh, savedMission, settled, test, volume } from "./support";

test.beforeEach(({ page }) => openExample(page));

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
  await open(page, { name: "m.yaml", text }, plazaMesh);
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

test("a height beyond the end of its slider is a limit", async ({ page }) => {
  await opened(page, "max_range: 300");
  await type(page, "high", "120");
  await expect(page.locator("#high-number")).toHaveValue("120 m");
  await expect(page.locator("#low-number")).toHaveValue("any");
  expect((await heights(page))[1]).toBeCloseTo(120, 3);
  expect(await agrees(page)).toContain("altitude: [ -1000, 120 ] # z -1000: no limit");
});

test("lengths have units, and what is not understood is refused with words", async ({ page }) => {
  await opened(page, "max_range: 300", "{keep_out: [{min: [20, 20, 0], max: [30, 30, 9]}]}");
  for (const [typed, metres] of [["400 ft", 121.92], ["400ft", 121.92], ["0.1 KM", 100], ["12,5 m", 12.5], ["0.05 mi", 80.4672], ["90", 90]] as const) {
    await type(page, "range", typed);
    expect((await mission(page)).maxRange).toBeCloseTo(metres, 9);
  }
  await type(page, "range", "400 ft");
  expect(await agrees(page)).toContain("max_range: 121.92");
  for (const [id, typed, said] of [
    ["range", "400 yd", "yd"], ["range", "400 M", "M"], ["range", "1,000 ft", "1000 or 1.000"], ["range", "60\u00b0", "\u00b0"], ["range", "ft", "metres"],
    ["slant", "60 m", "m"], ["high", "far", "metres"],
  ] as const) {
    const before = await mission(page);
    await type(page, id, typed);
    await expect(page.locator("#hint")).toContainText(said);
    expect(await mission(page)).toEqual(before);
    await expect(page.locator(`#${id}-number`)).not.toHaveValue(typed);
  }
  await type(page, "slant", "60 deg");
  expect((await mission(page)).incidence).toBe(60);
  const corner = page.getByLabel("box 1, to z, metres");
  await corner.fill("100 ft");
  await corner.press("Enter");
  await drawn(page);
  expect((await mission(page)).keepOut[0].max[2]).toBeCloseTo(30.48, 9);
  await corner.fill("100 yd");
  await corner.press("Enter");
  await expect(page.locator("#hint")).toContainText("yd");
  expect((await mission(page)).keepOut[0].max[2]).toBeCloseTo(30.48, 9);
});

test("a mission file may have units, too", async ({ page }) => {
  await opened(page, `max_range: 400 ft, min_range: 10 ft, incidence: 70 deg, ${camera}, pixel: {size: 2 cm}, mount: {yaw: 30 deg, pitch: -45 deg}`, "{altitude: [3, 150 ft]}");
  const { maxRange, minRange, incidence, altitude, pixel, tilt } = await mission(page);
  expect([maxRange, minRange, incidence, altitude, pixel, tilt]).toEqual([121.92, 3.048, 70, [3, 45.72], 0.02, -45]);
  await type(page, "range", "100");
  const text = await agrees(page);
  expect(text).toContain("min_range: 10 ft"); // what was not edited stays as it was written
  expect(text).toContain("max_range: 100");
  await type(page, "tilt", "any");
  expect(await savedMission(page)).toContain("yaw: 30 deg");
});

test("every limit is listed, and zones are drawn, whatever the page has controls for", async ({ page }) => {
  await opened(page, `max_range: 100, ${camera}, gimbal: {pitch: [-80, 10]}`,
    "{clearance: 2.5, keep_in: [{min: [-90, -90, 0], max: [90, 90, 80]}], keep_out: [{polygon: [[30, 30], [50, 30], [50, 50]], heights: any}]}");
  const lines = await page.locator("#limit-lines").textContent();
  for (const words of ["100 m", "-80\u00b0 to 10\u00b0", "2.5 m from all that is not ground", "Keep in, zone 0", "Keep out, zone 0", "any height"]) {
    expect(lines).toContain(words);
  }
  expect(await page.evaluate(() => (window as any).vantage.zones.count as number)).toBe(2);
  await expect(page.locator("#credit")).toBeHidden();
});

test("where one end of a band is taken away, the other one stays", async ({ page }) => {
  await opened(page, "max_range: 300", "{altitude: [3, 120]} # the rule");
  await page.locator("#low").press("Home");
  await settled(page);
  await expect(page.locator("#low-number")).toHaveValue("any");
  await expect(page.locator("#high-number")).toHaveValue("120 m");
  expect((await heights(page))[0]).toBeLessThan(2.9);
  expect((await heights(page))[1]).toBeCloseTo(120, 3);
  await agrees(page);
  await type(page, "low", "3");
  expect(await agrees(page)).toContain("[ 3, 120 ]");
  await page.locator("#high").press("End");
  await settled(page);
  await expect(page.locator("#high-number")).toHaveValue("any");
  expect((await heights(page))[1]).toBeGreaterThan(290);
  await agrees(page);
  await type(page, "range", "2500"); // and the end stays open
  const text = await agrees(page);
  expect(text).toContain("# the rule");
  expect((await heights(page))[1]).toBeGreaterThan(2400);

  await reopen(page, text);
  await expect(page.locator("#low-number")).toHaveValue("3 m");
  await expect(page.locator("#high-number")).toHaveValue("any");
  await type(page, "low", "any");
  expect(await agrees(page)).not.toContain("altitude");
});

test("an end that a file gives is open only where the page wrote it, and it limits nothing", async ({ page }) => {
  for (const [written, shown] of [
    ["[3, 1000]", "1000 m"], ["[3, 60] # z 1000: no limit", "60 m"], ["[3, 100] # z 100: no limit", "100 m"],
    ["[3, 1000] # as agreed; z 1000: no limit", "any"], ["{z: [3, 1000]} # z 1000: no limit", "any"],
  ]) {
    await openMission(page, `target: {${square}}\nsensor: {max_range: 300}\nnavigation:\n  altitude: ${written}\n`);
    await expect(page.locator("#high-number")).toHaveValue(shown!);
  }
  await type(page, "high", "50");
  await type(page, "low", "any");
  expect(await agrees(page)).toContain("altitude: { z: [ -1000, 50 ] } # z -1000: no limit");
});

test("heights above the ground have open ends, too", async ({ page }) => {
  await opened(page, "max_range: 90", "{ground: 0, altitude: {agl: [3, 20]}}");
  await page.locator("#high-agl").press("End");
  await settled(page);
  await expect(page.locator("#high-agl-number")).toHaveValue("any");
  await expect(page.locator("#low-agl-number")).toHaveValue("3 m");
  expect((await heights(page))[1]).toBeGreaterThan(80);
  expect(await agrees(page)).toContain("agl: [ 3, 1000 ]");
  const text = await savedMission(page);
  await reopen(page, text);
  expect((await mission(page)).agl).toEqual([3, null]);
  await type(page, "high-agl", "130");
  await type(page, "low-agl", "");
  await expect(page.locator("#high-agl-number")).toHaveValue("130 m");
  await agrees(page);
  await type(page, "high-agl", "any");
  expect(await agrees(page)).not.toContain("navigation"); // ground without such heights is refused
});

test("the ends of sliders can be reached in every scene", async ({ page }) => {
  const tent = "o ground\nv -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nf 1 2 3 4\no tent\nv 8 8 0\nv 12 8 0\nv 10 12 0\nv 10 10 9\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
  const isCut = () => page.evaluate(() => (window as any).vantage.cut !== null);
  for (const name of ["plaza.obj", "tent.obj"]) {
    if (name === "tent.obj") {
      const text = "scene: {mesh: tent.obj}\ntarget: {vertices: [[-5, -5, 0], [5, -5, 0], [0, 5, 0]]}\nsensor: {max_range: 30}\n";
      await open(page, { name: "m.yaml", text }, { name, text: tent });
      await expect.poll(async () => (await mission(page)).range).toBe(30);
      await drawn(page);
    }
    for (const id of ["high", "high-agl"]) {
      await type(page, id, "5");
      await page.locator(`#${id}`).press("End");
      await drawn(page);
      await expect(page.locator(`#${id}-number`)).toHaveValue("any");
    }
    for (const axis of ["2", "0", "1"]) {
      await page.selectOption("#cut-axis", axis);
      await page.locator("#cut").press("ArrowLeft");
      expect(await isCut()).toBe(true);
      await page.locator("#cut").press("End");
      expect(await isCut()).toBe(false);
    }
  }
});

test("the tilt and the pixel leave what else a file says of the camera", async ({ page }) => {
  await opened(page, `${camera}, max_range: 60, mount: {yaw: 30, pitch: -90, roll: 5}, pixel: {size: 0.02, kind: perpendicular}`);
  await type(page, "tilt", "-85");
  await page.selectOption("#pixel", "0.05");
  await settled(page);
  const text = await agrees(page);
  expect(text).toContain("mount: { yaw: 30, pitch: -85, roll: 5 }");
  expect(text).toContain("pixel: { size: 0.05, kind: perpendicular }");
  await type(page, "tilt", "any");
  const free = await agrees(page);
  expect(free).toContain("gimbal: { yaw: 30, roll: 5 }");
  expect(free).not.toContain("mount");

  await opened(page, `${camera}, max_range: 60, gimbal: {pitch: [-60, 0], yaw: 30}, dori: recognition`);
  await expect(page.locator("#pixel")).toHaveValue("0.008");
  await type(page, "tilt", "-50");
  await page.selectOption("#pixel", "0.02");
  await settled(page);
  const fixed = await agrees(page);
  expect(fixed).toContain("mount: { yaw: 30, pitch: -50 }");
  expect(fixed).toContain("pixel: { size: 0.02, kind: perpendicular }");
  await type(page, "tilt", "any");
  expect(await agrees(page)).toContain("pitch: [ -60, 0 ]");
});

test("a target that is drawn has not the front of the file's", async ({ page }) => {
  await openMission(page, `target: {vertices: [[-8, -8, 9], [4, -8, 9], [4, 3, 9], [-8, 3, 9]], front: [0, 0, -1]}\nsensor: {max_range: 40}\n`);
  const normal = () => page.evaluate(() => (window as any).vantage.volume.info.normal[2] as number);
  const { target } = await mission(page);
  await drag(page, target.vertices[0], { x: 8, y: 4 });
  expect(await agrees(page)).toContain("front: [ 0, 0, -1 ]");
  expect(await normal()).toBe(-1);
  await page.keyboard.press("d");
  for (const at of [[-5, -5, 0], [5, -5, 0], [5, 4, 0]]) {
    const { x, y } = await onScreen(page, at);
    await page.mouse.click(x, y);
  }
  await page.keyboard.press("Enter");
  await settled(page);
  expect(await normal()).toBeCloseTo(1, 6);
  expect(await agrees(page)).not.toContain("front");
});

test("the range is the number of the file, and the page gives one where it must", async ({ page }) => {
  await opened(page, `max_range: 300, ${camera}, pixel: {size: 0.01}`);
  await expect(page.locator("#range-number")).toHaveValue("300 m");
  await page.selectOption("#pixel", "");
  await settled(page);
  expect((await heights(page))[1]).toBeGreaterThan(250);
  await agrees(page);

  await opened(page, `${camera}, pixel: {size: 0.01}`);
  await expect(page.locator("#range-number")).toHaveValue(/any \(\d+\.?\d* m\)/);
  const free = await volume(page);
  await type(page, "range", "30");
  expect(await volume(page)).toBeLessThan(free);
  expect(await agrees(page)).toContain("max_range: 30");
  await type(page, "range", "any");
  expect(await volume(page)).toBe(free);
  await page.selectOption("#camera", "");
  await settled(page);
  expect(await agrees(page)).toContain("max_range: ");
});

test("a range that is set takes the place of the sight of a pilot", async ({ page }) => {
  await openMission(page, "target: {point: [0, 0, 2]}\nsensor: {vlos: {aircraft_size: 0.4, kind: multirotor, visibility: 5000}}\n");
  await expect(page.locator("#range-number")).toHaveValue(/any/);
  await agrees(page);
  await type(page, "range", "40");
  const text = await agrees(page);
  expect(text).toContain("max_range: 40");
  expect(text).not.toContain("vlos");
  await type(page, "range", "any");
  expect(await agrees(page)).toContain("vlos");
});

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

test("without a target nothing is said of the last volume", async ({ page }) => {
  await page.locator("#cut").fill("20");
  await expect(page.locator("#cut-out")).toContainText("m²");
  await page.evaluate(() => {
    const app = (window as any).vantage;
    app.edit((m: any) => (m.target = { kind: "polygon", vertices: [[-9, -9, 0], [9, -9, 0], [0, -6, 0], [-9, 9, 0]] }), true);
  });
  await expect(page.locator("#status")).toContainText("the volume shown is that of the last valid target");
  await page.evaluate(() => (window as any).vantage.edit((m: any) => (m.target = null), true));
  await expect(page.locator("#status")).toHaveText("No target yet");
  await expect(page.locator("#cut-out")).not.toContainText("m²");
});

test("a target that is raised is drawn where it is, and stays there when it is dragged", async ({ page }) => {
  await openMission(page, `target: {${square}, offset: 2}\nsensor: {max_range: 60}\n`);
  await agrees(page);
  const corner = (await mission(page)).target.vertices[0];
  expect(corner).toEqual([-8, -8, 2]);
  await drag(page, corner, { x: 8, y: 0 });
  for (const [, , z] of (await mission(page)).target.vertices) expect(z).toBeCloseTo(2, 6);
  expect(await agrees(page)).not.toContain("offset");
});
