// What the page shows, takes and gives.
import AxeBuilder from "@axe-core/playwright";
import { expect, type Page } from "@playwright/test";
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

test("a probe says and shows what hides the target", async ({ page }) => {
  const litTriangles = () => page.evaluate(() => (window as any).vantage.city.lit.geometry.getAttribute("position").count / 3);
  await page.evaluate(() => (window as any).vantage.setProbe([-2, -45, 12]));
  await expect(page.locator("#hint")).toContainText("hidden by");
  expect(await litTriangles()).toBeGreaterThan(0);
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  await expect(page.locator("#hint")).toContainText("Inside");
  expect(await litTriangles()).toBe(0);
  await page.click("#see");
  const eye = await page.evaluate(() => (window as any).vantage.stage.camera.position.z + (window as any).vantage.scene.origin[2]);
  expect(eye).toBeCloseTo(30, 6);
});

test("the volume is proved, cut and saved", async ({ page }) => {
  await page.click("#prove");
  await expect(page.locator("#proof")).toContainText("Proved");
  await page.locator("#cut").fill("20");
  await expect(page.locator("#cut-out")).toContainText("m²");
  const area = await page.locator("#cut-out").textContent();
  await page.locator("#cut-number").fill("33,5");
  await page.locator("#cut-number").press("Enter");
  expect(await page.evaluate(() => (window as any).vantage.cut.at)).toBe(33.5);
  await expect(page.locator("#cut-out")).not.toHaveText(area!);
  await page.locator("#cut-number").fill("high");
  await page.locator("#cut-number").press("Enter");
  await expect(page.locator("#cut-number")).toHaveValue("33.5 m");
  const formats = (await page.locator("#format option").allTextContents()).filter((one) => one !== "mission" && one !== "picture");
  expect(formats).toContain("ply");
  for (const format of formats) expect(readFileSync(await saved(page, format)).length).toBeGreaterThan(1000);
  // Under the view the picture has a line for each colour, and claims nothing of a target that the volume is not of.
  const drawn = async () => {
    await page.evaluate(() => {
      const texts: string[] = ((window as any).drawn = []);
      const { fillText } = CanvasRenderingContext2D.prototype;
      CanvasRenderingContext2D.prototype.fillText = function (text: string, ...rest) {
        texts.push(text);
        fillText.call(this, text, ...(rest as [number, number]));
      };
    });
    await saved(page, "picture");
    return page.evaluate(() => ((window as any).drawn as string[]).join("\n"));
  };
  expect(await drawn()).toContain("Every position in the volume sees all of the target.\nthe target");
  await page.evaluate(() => (window as any).vantage.edit((m: any) => (m.target.vertices = [[0, 0, 0], [9, 0, 0], [1, 1, 0], [0, 9, 0]]), true));
  await expect(page.locator("#status")).toContainText("no volume of this target");
  const failed = await drawn();
  expect(failed).toContain("no volume of this target");
  expect(failed).not.toContain("Every position");
  await page.keyboard.press("Control+z");
  await settled(page);
  const picture = readFileSync(await saved(page, "picture"));
  const [width, height] = [picture.readUInt32BE(16), picture.readUInt32BE(20)];
  const view = await page.evaluate(() => {
    const { canvas } = (window as any).vantage.stage;
    return { width: canvas.width, height: canvas.height, rows: document.querySelectorAll("#legend li").length };
  });
  expect(width).toBe(view.width);
  expect(view.rows).toBeGreaterThanOrEqual(3);
  expect(height).toBeGreaterThan(view.height + 15 * (view.rows + 2));
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
  await settled(page);
  expect(await page.evaluate(() => Boolean((window as any).vantage.source.isExample))).toBe(false);
  expect(await volume(page)).toBe(before);
});

const TENT = "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nf 1 2 3 4\nv 8 8 0\nv 12 8 0\nv 10 12 0\nv 10 10 9\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
const SMALL = "target: {vertices: [[-1, 1, 0.5], [1, 1, 0.5], [0, 3, 0.5]]}\nsensor: {max_range: 15}\n";
const nameOfScene = (page: Page) => page.evaluate(() => (window as any).vantage.source.name as string);

test("a mission alone is computed in the scene that it says, also where the mesh is open with other axes", async ({ page }) => {
  const mesh = { name: "tent.obj", text: TENT };
  const turned = { name: "up.yaml", text: `scene: {mesh: models/tent.obj, up: y, scale: 0.5}\n${SMALL}` };
  await open(page, mesh, turned);
  await expect.poll(async () => [await nameOfScene(page), (await mission(page)).range]).toEqual(["tent.obj", 15]);
  const wanted = await page.evaluate(() => [(window as any).vantage.scene.hash, (window as any).vantage.volume.info.volume_m3]);
  await open(page, mesh);
  await expect(page.locator("#hint")).toContainText("Draw a target");
  expect(await page.evaluate(() => (window as any).vantage.scene.hash)).not.toBe(wanted[0]);
  await open(page, turned);
  await expect.poll(async () => (await mission(page)).range).toBe(15);
  await settled(page);
  expect(await page.evaluate(() => [(window as any).vantage.scene.hash, (window as any).vantage.volume.info.volume_m3])).toEqual(wanted);
  expect(await savedMission(page)).toContain("up: y");
});

test("files beside a mission are taken also where its mesh is open already", async ({ page }) => {
  const block = (top: number) => "v -9 -9 1\nv 9 -9 1\nv 9 9 1\nv -9 9 1\n" +
    [[-9, -9], [9, -9], [9, 9], [-9, 9]].map(([x, y]) => `v ${x} ${y} ${top}`).join("\n") +
    "\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const text = `scene: {mesh: tent.obj}\n${SMALL}navigation: {meshes: [where.obj]}\n`;
  await open(page, { name: "tent.obj", text: TENT }, { name: "m.yaml", text }, { name: "where.obj", text: block(9) });
  await expect.poll(async () => [await nameOfScene(page), (await mission(page)).range]).toEqual(["tent.obj", 15]);
  const high = await volume(page);
  await open(page, { name: "m.yaml", text }, { name: "where.obj", text: block(5) });
  await expect.poll(() => page.evaluate(() => (window as any).vantage.volume?.info.volume_m3 as number)).toBeLessThan(0.8 * high);
  const low = await volume(page);
  await open(page, { name: "m.yaml", text: text.replace("15", "14") }); // the last ones are still there
  await expect.poll(async () => (await mission(page)).range).toBe(14);
  await settled(page);
  expect(await volume(page)).toBeLessThan(low);
  expect(await page.evaluate(() => (window as any).vantage.failure)).toBe("");
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

test("the reason why a target is none can be read wherever its corner is", async ({ page }) => {
  await page.evaluate(() => (window as any).vantage.edit(
    (m: any) => (m.target = { kind: "polygon", vertices: [[-9, -9, 0], [9, -9, 0], [0, -6, 0], [-9, 9, 0]] }), true));
  await expect(page.locator("#fault")).toContainText("not convex");
  const box = (await page.locator("#canvas").boundingBox())!;
  const look = (at: number[], from: number[]) => page.evaluate(([target, eye]) => {
    const { stage, city } = (window as any).vantage;
    stage.controls.target.copy(city.toView(target));
    stage.camera.position.copy(city.toView(eye));
    stage.controls.update();
    stage.request();
  }, [at, from]);
  // Above, below and beside the picture, and behind the camera.
  for (const [at, from] of [[[0, -60, 0], [0, -90, 30]], [[0, 60, 0], [0, 40, 40]], [[60, 0, 0], [60, -20, 20]], [[0, 60, 4], [0, 20, 10]]]) {
    await look(at!, from!);
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    const note = (await page.locator("#fault").boundingBox())!;
    expect(note.x).toBeGreaterThanOrEqual(box.x);
    expect(note.y).toBeGreaterThanOrEqual(box.y);
    expect(note.x + note.width).toBeLessThanOrEqual(box.x + box.width);
    expect(note.y + note.height).toBeLessThanOrEqual(box.y + box.height);
  }
});

test("a scene that is opened is looked at from outside, also where the view was that of the probe", async ({ page }) => {
  const camera = () => page.evaluate(() => (window as any).vantage.stage.camera.position.toArray() as number[]);
  await open(page, { name: "tent.obj", text: TENT });
  await expect.poll(() => nameOfScene(page)).toBe("tent.obj");
  const outside = await camera();
  await page.click("#example");
  await expect.poll(() => nameOfScene(page)).toBe("plaza.obj");
  await expect.poll(() => page.evaluate(() => Boolean((window as any).vantage.volume))).toBe(true);
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  await page.click("#see");
  await open(page, { name: "tent.obj", text: TENT });
  await expect.poll(() => nameOfScene(page)).toBe("tent.obj");
  const after = await camera();
  for (const axis of [0, 1, 2]) expect(after[axis]).toBeCloseTo(outside[axis]!, 6);
});

test("a file that is dropped while the page starts is opened after the example", async ({ page }) => {
  await page.goto("about:blank");
  await page.addInitScript((text) => {
    const timer = setInterval(() => {
      const app = (window as any).vantage;
      if (!app) return;
      clearInterval(timer);
      const event = new Event("drop");
      Object.defineProperty(event, "dataTransfer", { value: { files: [new File([text], "tent.obj")] } });
      window.dispatchEvent(event);
    }, 1);
  }, TENT);
  await page.goto(page_url);
  await expect.poll(() => page.evaluate(() => (window as any).vantage?.source.name as string)).toBe("tent.obj");
  await settled(page);
  await page.waitForTimeout(300);
  await settled(page);
  expect(await nameOfScene(page)).toBe("tent.obj");
  expect((await mission(page)).target).toBe(null);
});

test("keys turn and zoom the view, and scroll the panel where there is no probe", async ({ page }) => {
  const view = () => page.evaluate(() => {
    const { stage } = (window as any).vantage;
    const [x, y, z] = stage.camera.position.clone().sub(stage.controls.target).toArray() as [number, number, number];
    return { heading: stage.heading() as number, height: z / Math.hypot(x, y, z), distance: Math.hypot(x, y, z) };
  });
  const first = await view();
  await page.keyboard.press("Shift+ArrowRight");
  const turned = await view();
  expect(Math.abs(turned.heading - first.heading)).toBeGreaterThan(3);
  expect(turned.distance).toBeCloseTo(first.distance, 6);
  await page.keyboard.press("Shift+ArrowUp");
  const higher = await view();
  expect(higher.height).toBeGreaterThan(turned.height);
  for (let i = 0; i < 40; ++i) await page.keyboard.press("Shift+ArrowUp");
  expect((await view()).height).toBeLessThanOrEqual(1);
  expect((await view()).heading).toBeCloseTo(higher.heading, 3);
  await page.keyboard.press("+");
  expect((await view()).distance).toBeLessThan(0.95 * first.distance);
  await page.keyboard.press("-");
  expect((await view()).distance).toBeCloseTo(first.distance, 6);
  const isTaken = (key: string, init: object = {}) => page.evaluate(([name, more]) =>
    !document.body.dispatchEvent(new KeyboardEvent("keydown", { key: name as string, bubbles: true, cancelable: true, ...(more as object) })), [key, init]);
  for (const key of ["ArrowDown", "ArrowLeft", "PageDown"]) expect(await isTaken(key)).toBe(false);
  expect(await isTaken("ArrowDown", { shiftKey: true })).toBe(true);
  for (const key of ["d", "ArrowLeft"]) expect(await isTaken(key, { altKey: true })).toBe(false);
  await expect(page.locator("#tool-look")).toHaveAttribute("aria-pressed", "true");
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  expect(await isTaken("ArrowLeft")).toBe(true);
  expect(await page.evaluate(() => (window as any).vantage.probe.at[0])).not.toBe(0);
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
