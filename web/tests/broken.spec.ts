// Bad input, and browsers that lack something: a message, and nothing lost.
import { expect, test as plain, type Page } from "@playwright/test";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { byProgram, copiedLink, hasVolume, mission, open, openExample, page_url, plaza, plazaMesh, savedMission, settled, test, volume } from "./support";

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

/** The tower's wall goes through its target. `limits`: all that the file says besides. */
const PIERCED = "[[20, -3, 0], [26, -3, 0], [26, 0, 0], [20, 0, 0]]";
const LIMITS = `sensor: {max_range: 90, incidence: 70, min_range: 4} # as agreed
navigation:
  altitude: [3, 50]
  clearance: 2
  keep_out:
    - {min: [-9, -9, 20], max: [9, 9, 30]} # the crane
    - {polygon: [[30, 30], [50, 30], [50, 50]], heights: any}
tour: {vehicle: {kind: multirotor, speed: 8}, clearance: 4}
exact: {tolerance: 0.02}
`;

test("a mission whose target is refused keeps its limits, and its target is drawn where it lies", async ({ page }) => {
  await openExample(page);
  const text = `scene: {mesh: plaza.obj}\n# where the flea market is\ntarget: {name: flea market, vertices: ${PIERCED}}\n${LIMITS}`;
  await open(page, { name: "m.yaml", text }, plazaMesh);
  await expect(page.locator("#hint")).toContainText("church_tower");
  await expect(page.locator("#hint")).toHaveClass(/bad/);
  await settled(page);
  const { maxRange, minRange, incidence, altitude, keepOut, target } = await mission(page);
  expect({ maxRange, minRange, incidence, altitude, keepOut, target: target.vertices }).toEqual({
    maxRange: 90, minRange: 4, incidence: 70, altitude: [3, 50], keepOut: [{ min: [-9, -9, 20], max: [9, 9, 30] }], target: JSON.parse(PIERCED),
  });
  await expect(page.locator("#status")).toHaveText("There is no volume of this target");
  await expect(page.locator("#range-number")).toHaveValue("90 m");
  await expect(page.locator("#limit-lines")).toContainText("2 m from all that is not ground");
  const drawn = () => page.evaluate(() => {
    const { zones, target, volumeView, volume } = (window as any).vantage;
    return { zones: zones.count, red: target.fill.visible && target.fill.material.color.getHex() === 0xc41230, volume, facets: volumeView.mesh?.visible };
  });
  expect(await drawn()).toMatchObject({ zones: 1, red: true, volume: null });

  // A target that can be seen takes its place, and nothing else does.
  const square = [[-8, -8, 0], [4, -8, 0], [4, 3, 0], [-8, 3, 0]];
  await page.evaluate((vertices) => (window as any).vantage.edit((m: any) => (m.target = { kind: "polygon", vertices }), true), square);
  await hasVolume(page);
  await settled(page);
  const saved = await savedMission(page);
  const rest = (all: string) => all.slice(all.indexOf("sensor:")).replace(/\s+/g, "");
  expect(rest(saved)).toBe(rest(text));
  expect(saved).toContain("# where the flea market is");
  expect(Math.abs((await volume(page)) / byProgram(saved) - 1)).toBeLessThan(1e-12);

  await page.keyboard.press("Control+z");
  await settled(page);
  await expect(page.locator("#hint")).toContainText("church_tower");
  expect((await mission(page)).target.vertices).toEqual(JSON.parse(PIERCED));
});

test("a mission of several targets of which one is refused keeps all", async ({ page }) => {
  await openExample(page);
  const text = `targets:\n  - {point: [0, 0, 2]}\n  - {vertices: ${PIERCED}}\n${LIMITS}`;
  await open(page, { name: "m.yaml", text });
  await expect(page.locator("#hint")).toContainText("church_tower");
  await settled(page);
  expect(await mission(page)).toMatchObject({ maxRange: 90, target: { kind: "written" }, parts: [JSON.parse(PIERCED), [[0, 0, 2]]] });
  await page.locator("#range").fill("40");
  await settled(page);
  expect(await mission(page)).toMatchObject({ maxRange: 40, incidence: 70, altitude: [3, 50] });
});

test("boxes that are not edited stay as they were written", async ({ page }) => {
  await openExample(page);
  const target = "target: {vertices: [[-8, -8, 0], [4, -8, 0], [4, 3, 0], [-8, 3, 0]]}";
  await open(page, { name: "m.yaml", text: `${target}\n${LIMITS.replace("max: [9, 9, 30]", "max: [3e1, 9, 30]")}` }, plazaMesh);
  await expect.poll(async () => (await mission(page)).maxRange).toBe(90);
  await page.click("#add-box");
  await settled(page);
  const saved = await savedMission(page);
  expect(saved).toContain("max: [ 3e+1, 9, 30 ]");
  expect(saved).toContain("# the crane");
  expect(saved).toContain("heights: any");
  expect((await mission(page)).keepOut.length).toBe(2);
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
