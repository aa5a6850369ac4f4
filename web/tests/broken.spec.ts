// Bad input, and browsers that lack something: a message, and nothing lost.
import { expect, test as plain, type Page } from "@playwright/test";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { copiedLink, hasVolume, mission, open, openExample, page_url, plaza, settled, test, volume } from "./support";

plain("without WebGL the page says so", async ({ page }) => {
  await page.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null));
  await page.goto(page_url);
  await expect(page.locator("#hint")).toContainText("WebGL");
});

test("without WebAssembly the page says so", async ({ page }) => {
  await page.addInitScript(() => Reflect.deleteProperty(window, "WebAssembly"));
  await page.goto(page_url);
  await expect(page.locator("#hint")).toContainText("WebAssembly");
});

test("a mesh that is too large is refused before it is read", async ({ page }) => {
  await openExample(page);
  const before = await volume(page);
  await page.evaluate(() => {
    const file = new File(["x"], "city.obj");
    Object.defineProperty(file, "size", { value: 650e6 });
    Object.defineProperty(file, "arrayBuffer", { value: () => { throw new Error("was read"); } });
    const event = new Event("drop");
    Object.defineProperty(event, "dataTransfer", { value: { files: [file] } });
    window.dispatchEvent(event);
  });
  await expect(page.locator("#hint")).toContainText("650 MB");
  expect(await volume(page)).toBe(before);
});

for (const [what, name, text] of [
  ["no triangles", "empty.obj", "v 0 0 0\nv 1 0 0\n"],
  ["half a PLY", "half.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 9\n"],
  ["not a GLB", "not.glb", "glTF but not really"],
  ["not a mesh", "notes.txt", "hello"],
  ["a mission that is not YAML", "broken.yaml", "target: [1, 2\nsensor: }"],
  ["a mission with an unknown key", "odd.yaml", "target: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\nsensor: {max_rang: 5}\n"],
  ["a mission for a map", "map.yaml", "scene: {osm: city.osm}\ntarget: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n"],
  ["a mission for another mesh", "other.yaml", "scene: {mesh: other.obj}\n"],
] as const) {
  test(`${what} is said, and the volume stays`, async ({ page }) => {
    await openExample(page);
    const before = [await volume(page), await mission(page)];
    await open(page, { name, text });
    await expect(page.locator("#hint")).toHaveClass("bad");
    await settled(page);
    expect([await volume(page), await mission(page)]).toEqual(before);
    await page.locator("#range").fill("40"); // and all still works
    await settled(page);
    expect(await volume(page)).toBeLessThan(before[0] as number);
  });
}

test("an error of a mission file says its line and column, and no folder", async ({ page }) => {
  await openExample(page);
  const text = "# a comment\nscene: {mesh: plaza.obj}\ntarget: {vertices: [[-5, -5, 0], [5, -5, 0], [0, 5, 0]]}\nsensor:\n  max_range: 11\n";
  await open(page, { name: "odd.yaml", text: `${text}  max_rang: 11\n` });
  await expect(page.locator("#hint")).toContainText("in sensor (line 6, column 3):");
  await open(page, { name: "zones.yaml", text: `${text}navigation:\n  keep_in: [{file: zones.geojson}]\n` });
  await expect(page.locator("#hint")).toContainText("(line 7, column 20, zones.geojson):");
  // What the page wrote has no lines that anybody knows.
  await page.evaluate((written) => (window as any).vantage.edit((m: any) => (m.written = written), true), `${text}  max_rang: 11\n`.replace(/scene.*/, ""));
  await expect(page.locator("#hint")).toContainText("in sensor: did you mean");
});

test("where a link cannot be made, the reason is said", async ({ page }) => {
  await openExample(page);
  await page.evaluate(() => {
    const { mission } = (window as any).vantage;
    mission.written = "crs: EPSG:25832\nnavigation: {keep_out: [{min: [0, 0, 0], max: [1, 1, 1]}]}\n";
    mission.opened.target = null;
  });
  await page.click("#link");
  await expect(page.locator("#hint")).toContainText("move its target in the file");
});

test("what else is given in map coordinates is not taken for the scene's", async ({ page }) => {
  await openExample(page);
  const others = {
    "navigation: {rings: []}": "limits",
    "tour: {home: [6e5, 5e6, 0]}": "home",
    "links: [{point: [6e5, 5e6, 2], frequency: 2.4}]": "links",
  };
  for (const [written, what] of Object.entries(others)) {
    await page.evaluate((text) => {
      const { mission } = (window as any).vantage;
      mission.written = `crs: EPSG:25832\n${text}\n`;
      mission.opened.target = null;
    }, written);
    await page.click("#link");
    await expect(page.locator("#hint")).toContainText(`gives its ${what} in EPSG:25832`);
  }
});

const packedLink = (link: object) => gzipSync(JSON.stringify(link)).toString("base64url");

const TENT = "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nf 1 2 3 4\nv 8 8 0\nv 12 8 0\nv 10 12 0\nv 10 10 9\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
const SMALL = "target: {vertices: [[-5, -5, 0], [5, -5, 0], [0, 5, 0]]}\nsensor: {max_range: 11}\n";
const sceneName = (page: Page) => page.evaluate(() => (window as any).vantage?.source.name as string);
const range = (page: Page) => page.evaluate(() => (window as any).vantage?.volume?.info.range_m as number);

test("a mesh with a mission that fails does not take the place of what is open", async ({ page }) => {
  await openExample(page);
  await page.locator("#range").fill("40");
  await settled(page);
  const before = [await volume(page), await mission(page)];
  await open(page, { name: "tent.obj", text: TENT }, { name: "odd.yaml", text: SMALL.replace("max_range", "max_rang") });
  await expect(page.locator("#hint")).toContainText("max_rang");
  await hasVolume(page);
  await settled(page);
  await expect(page.locator("#hint")).toContainText("max_rang");
  expect([await volume(page), await mission(page), await sceneName(page)]).toEqual([...before, "plaza.obj"]);
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await range(page)).toBe(70);
});

test("a scene that is opened again has its mission, which can still be undone", async ({ page }) => {
  await openExample(page);
  await page.locator("#range").fill("40");
  await settled(page);
  const before = [await volume(page), await mission(page)];
  await open(page, { name: "tent.obj", text: TENT });
  await expect.poll(() => sceneName(page)).toBe("tent.obj");
  expect((await mission(page)).target).toBe(null);
  await open(page, { name: "plaza.obj", text: readFileSync(join(plaza, "plaza.obj"), "utf8") });
  await hasVolume(page);
  await settled(page);
  expect([await volume(page), await mission(page)]).toEqual(before);
  await page.keyboard.press("Control+z");
  await settled(page);
  expect(await range(page)).toBe(70);
});

test("a link of an own file goes with that file, whatever its name", async ({ page }) => {
  await openExample(page);
  await open(page, { name: "plaza.obj", text: TENT }, { name: "m.yaml", text: SMALL });
  await expect.poll(() => range(page)).toBe(11);
  const before = [await volume(page), await page.evaluate(() => (window as any).vantage.scene.hash)];
  const link = await copiedLink(page);
  await page.goto("about:blank");
  await page.goto(link);
  await expect.poll(() => range(page)).toBe(11);
  expect([await volume(page), await page.evaluate(() => (window as any).vantage.scene.hash)]).toEqual(before);
});

test("a link that waits for a file does not take another one of the same name", async ({ page }) => {
  await openExample(page);
  let noise = TENT;
  for (let i = 0; i < 4000; ++i) noise += `v ${Math.random()} ${Math.random()} ${-Math.random()}\n`;
  await open(page, { name: "large.obj", text: noise }, { name: "m.yaml", text: SMALL.replaceAll(", 0]", ", 1]") });
  await expect.poll(() => range(page)).toBe(11);
  const link = await copiedLink(page);
  await page.goto("about:blank");
  await page.goto(link);
  await expect(page.locator("#hint")).toContainText("open that file");
  await open(page, { name: "large.obj", text: `${noise}v 1 1 12\nf 1 2 -1\n` });
  await expect(page.locator("#hint")).toContainText("another large.obj");
  expect((await mission(page)).target).toBe(null);
  await open(page, { name: "large.obj", text: noise });
  await expect.poll(() => range(page)).toBe(11);
});

test("links of earlier versions open", async ({ page }) => {
  await openExample(page);
  const packed = packedLink({ scene: "plaza.obj", section: { mesh: "plaza.obj", up: "z" }, mission: SMALL.replaceAll(", 0]", ", 1]") });
  await page.goto("about:blank");
  await page.goto(`${page_url}#${packed}`);
  await expect.poll(() => range(page)).toBe(11);
});

test("a mission that is too long is refused before the engine has it", async ({ page }) => {
  await openExample(page);
  const before = [await volume(page), await mission(page)];
  const long = `# ${"x".repeat(1.2 * 2 ** 20)}\n`;
  await open(page, { name: "long.yaml", text: `${SMALL}${long}` });
  await expect(page.locator("#hint")).toContainText("1 MiB");
  for (const mission of [`${SMALL}${long}`, `${SMALL}${long.repeat(9)}`]) {
    const packed = packedLink({ scene: "plaza.obj", section: { mesh: "plaza.obj", up: "z" }, mission });
    await page.keyboard.press("Escape");
    await page.goto(`${page_url}#${packed}`);
    await expect(page.locator("#hint")).toContainText("1 MiB");
  }
  expect([await volume(page), await mission(page)]).toEqual(before);
});

test("a link of a small scene holds the scene; of another one its mission waits for the file", async ({ page }) => {
  await openExample(page);
  await open(page, { name: "tent.obj", text: TENT });
  await page.waitForFunction(() => (window as any).vantage.source.name === "tent.obj");
  await page.evaluate(() => (window as any).vantage.edit(
    (m: any) => (m.target = { kind: "polygon", vertices: [[-5, -5, 0], [5, -5, 0], [0, 5, 0]] }), true));
  await page.waitForFunction(() => (window as any).vantage.volume);
  await settled(page);
  const before = await volume(page);
  const link = await copiedLink(page);
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForFunction(() => (window as any).vantage?.source.name === "tent.obj" && (window as any).vantage.volume);
  expect(await volume(page)).toBe(before);

  // A scene that does not fit into a link.
  let noise = TENT;
  for (let i = 0; i < 4000; ++i) noise += `v ${Math.random()} ${Math.random()} ${-Math.random()}\n`;
  await open(page, { name: "large.obj", text: noise });
  await page.waitForFunction(() => (window as any).vantage.source.name === "large.obj");
  await page.evaluate(() => (window as any).vantage.edit(
    (m: any) => (m.target = { kind: "polygon", vertices: [[-5, -5, 0], [5, -5, 0], [0, 5, 0]] }), true));
  await page.waitForFunction(() => (window as any).vantage.volume);
  await page.locator("#range").fill("11");
  await settled(page);
  const other = await volume(page);
  const short = await copiedLink(page);
  await page.goto("about:blank");
  await page.goto(short);
  await expect(page.locator("#hint")).toContainText("large.obj");
  await open(page, { name: "large.obj", text: noise });
  await page.waitForFunction(() => (window as any).vantage.mission.range === 11 && (window as any).vantage.volume);
  expect(await volume(page)).toBe(other);
});
