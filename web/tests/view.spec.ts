// The page that the program serves, and the reports that it writes.
import { expect, test } from "@playwright/test";
import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { byProgram, drag, hasVolume, hideVolume, mission, onScreen, open, plaza, program, root, saved, savedMission, settled, volume } from "./support";

const file = join(plaza, "mission.yaml");
let server: ChildProcess;
let address: string;

test.describe("vantage view", () => {
  const serve = async (served: string) => {
    server = spawn(program, ["view", served, "--no-browser", "--page", join(root, "web/dist/index.html")]);
    address = await new Promise((resolve, reject) => {
      server.stdout!.once("data", (text: Buffer) => resolve(text.toString().trim()));
      server.once("exit", (code) => reject(new Error(`the program ended with ${code}`)));
    });
  };
  test.beforeEach(() => serve(file));
  test.afterEach(() => server.kill("SIGINT"));

  test("serves its mission, which follows what is dragged", async ({ page }) => {
    const problems: string[] = [];
    page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => {
      if (!request.url().startsWith(new URL(address).origin) && !/^(blob|data):/.test(request.url())) problems.push(request.url());
    });
    await page.goto(address);
    await hasVolume(page);
    expect(Math.abs((await volume(page)) / byProgram(readFileSync(file, "utf8")) - 1)).toBeLessThan(1e-12);
    const { target } = await mission(page);
    await drag(page, target.vertices[0], { x: 24, y: -16 });
    const text = await savedMission(page);
    expect(Math.abs((await volume(page)) / byProgram(text) - 1)).toBeLessThan(1e-12);
    expect(readFileSync(await saved(page, "ply")).length).toBeGreaterThan(1000);
    await page.click("#prove");
    await expect(page.locator("#proof")).toContainText("Proved");
    expect(problems).toEqual([]);
  });

  test("a mission whose target is refused is shown with all its limits", async ({ page }) => {
    const folder = mkdtempSync(join(tmpdir(), "vantage-"));
    const text = readFileSync(file, "utf8").replace("plaza.obj ", `${join(plaza, "plaza.obj")} `).replace("[11, 0, 0]", "[27, 0, 0]");
    writeFileSync(join(folder, "refused.yaml"), text);
    server.kill("SIGINT");
    await serve(join(folder, "refused.yaml"));
    await page.goto(address);
    await expect(page.locator("#hint")).toContainText("church_tower");
    await settled(page);
    const { maxRange, altitude, keepOut, target } = await mission(page);
    expect([maxRange, altitude, keepOut, target.vertices[2]]).toEqual([70, [3, 50], [{ min: [18, -10, 0], max: [35, 7, 43] }], [27, 0, 0]]);
    await expect(page.locator("#status")).toHaveText("There is no volume of this target");
    await page.evaluate(() => (window as any).vantage.edit((m: any) => (m.target.vertices[2] = [11, 0, 0]), true));
    await hasVolume(page);
    const limits = (all: string) => all.slice(all.indexOf("sensor:")).replace(/\s+/g, "");
    expect(limits(await savedMission(page))).toBe(limits(text));
  });

  test("stops what takes long, and shows the last volume", async ({ page }) => {
    await page.goto(address);
    await hasVolume(page);
    await hideVolume(page);
    const body = "target: {vertices: [[-8, -8, 0], [-6, -8, 0], [-7, -6, 0]]}\nsensor: {max_range: 3}\nexact: {tolerance: 0.00001}\n";
    await page.evaluate((text) => (window as any).vantage.openMission(text), body);
    const before = await volume(page);
    const edit = (range: number) => page.evaluate((value) => (window as any).vantage.edit((m: any) => (m.maxRange = value), true), range);
    await edit(60);
    await page.click("#stop");
    await expect(page.locator("#hint")).toContainText("stopped");
    await settled(page);
    expect(await volume(page)).toBe(before);
    await edit(4);
    await settled(page);
    expect(await volume(page)).toBeGreaterThan(before);
    await expect(page.locator("#hint")).toBeHidden();
  });

  test("says that the program is gone, and keeps the mission", async ({ page }) => {
    await page.goto(address);
    await hasVolume(page);
    const ended = new Promise((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    expect(await ended).toBe(0);
    await expect(page.locator("#hint")).toContainText("is lost");
    expect(await savedMission(page)).toContain("vertices");
  });

  test("keeps others out", async ({ page, request }) => {
    const { origin, searchParams } = new URL(address);
    const token = searchParams.get("token")!;
    for (const path of ["/", "/?token=", `/?token=${"0".repeat(32)}`, "/socket", `/etc/passwd?token=${token}`]) {
      expect((await request.get(origin + path)).status(), path).toBe(403);
    }
    expect((await request.get(address, { headers: { Host: "evil.example" } })).status()).toBe(421);
    expect((await request.post(address)).status()).toBe(405);
    // Another page may not open the socket.
    await page.goto("about:blank");
    const outcome = await page.evaluate(
      (url) => new Promise((resolve) => {
        const socket = new WebSocket(url);
        socket.onopen = () => resolve("open");
        socket.onerror = () => resolve("refused");
      }), `ws://${new URL(origin).host}/socket?token=${token}`);
    expect(outcome).toBe("refused");
  });

  test("a used port is said", () => {
    const { port } = new URL(address);
    try {
      execFileSync(program, ["view", file, "--no-browser", "--port", port, "--page", join(root, "web/dist/index.html")], { stdio: "pipe" });
      expect("it ended").toBe("with an error");
    } catch (error) {
      expect((error as { status: number }).status).toBe(2);
    }
  });
});

test("a tileset alone takes a target, and is saved with it", async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  execFileSync(program, ["compute", join(root, "examples/town/mission.yaml"), "-q", "-o", join(folder, "town.tiles")]);
  const tileset = join(folder, "town.tiles/tileset.json");
  const viewer = spawn(program, ["view", tileset, "--no-browser", "--page", join(root, "web/dist/index.html")]);
  try {
    await page.goto(await new Promise<string>((resolve) => viewer.stdout.once("data", (text: Buffer) => resolve(text.toString().trim()))));
    await expect(page.locator("#hint")).toContainText("Draw a target");
    await expect(page).toHaveTitle(/^tileset.json/);
    await page.evaluate(() => (window as any).vantage.edit((m: any) => {
      m.target = { kind: "polygon", vertices: [[0, 0, 300], [4, 0, 300], [0, 4, 300]] }; // high above it
      m.maxRange = 50;
    }, true));
    await hasVolume(page);
    const text = await savedMission(page);
    expect(text).toContain('tiles: "tileset.json"');
    expect(text).not.toContain("mesh:");
    writeFileSync(join(folder, "town.tiles/mission.yaml"), text);
    const report = execFileSync(program, ["compute", join(folder, "town.tiles/mission.yaml"), "-o", join(folder, "v.ply"), "--json", "-q"]);
    expect(await volume(page)).toBeCloseTo(JSON.parse(report.toString()).volume_m3, 6);
  } finally {
    viewer.kill("SIGINT");
  }
});

test("in a map a square is picked, and heights count from the ground", async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  const corner = (id: number, east: number, north: number) => `<node id="${id}" version="1" lat="${48 + north / 111000}" lon="${11 + east / 74000}"/>`;
  const area = (id: number, key: string, value: string) => `<way id="${id}" version="1">${[1, 2, 3, 4, 1].map((n) => `<nd ref="${10 * id + n}"/>`).join("")}` +
    `<tag k="${key}" v="${value}"/>${key === "building" ? '<tag k="height" v="9"/>' : ""}</way>`;
  const box = (id: number, x: number, y: number, size: number) =>
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(([u, v], n) => corner(10 * id + n + 1, x + u! * size, y + v! * size)).join("");
  writeFileSync(join(folder, "map.osm"), `<osm version="0.6">${box(1, 0, 0, 30)}${box(2, 50, 0, 20)}` +
    `${area(1, "leisure", "pitch")}${area(2, "building", "yes")}</osm>`);
  writeFileSync(join(folder, "mission.yaml"), "scene: {osm: map.osm}\ntarget: {osm: way/2, part: roof}\nsensor: {max_range: 60}\n");
  const viewer = spawn(program, ["view", join(folder, "mission.yaml"), "--no-browser", "--page", join(root, "web/dist/index.html")]);
  try {
    await page.goto(await new Promise<string>((resolve) => viewer.stdout.once("data", (text: Buffer) => resolve(text.toString().trim()))));
    await hasVolume(page);
    const roof = await page.evaluate(() => (window as any).vantage.volume.info.center as number[]);
    await page.keyboard.press("p");
    const at = await onScreen(page, [roof[0]! - 45, roof[1]! + 5, 0]);
    await page.mouse.click(at.x, at.y);
    await expect.poll(async () => (await mission(page)).target.osm).toBe("way/1");
    await settled(page);
    await expect.poll(() => page.evaluate(() => (window as any).vantage.volume.info.target[0].length as number)).toBe(4);
    expect(await savedMission(page)).toContain("osm: way/1");
    const ends = () => page.evaluate(() => (window as any).vantage.volumeView.heights() as number[]);
    await page.locator("#high-agl").fill("20");
    await settled(page);
    expect((await ends())[1]).toBeCloseTo(20, 3);
    await page.locator("#low").fill("4");
    await settled(page);
    expect((await ends())[0]).toBeGreaterThan(3.999);
    const both = await savedMission(page);
    expect(both).toContain("altitude: { z: [ 4, 1000 ], agl: [ -1000, 20 ] } # z 1000: no limit; agl -1000: no limit");
    for (const id of ["#high-agl", "#low"]) await page.locator(id).evaluate((slider: HTMLInputElement) => {
      slider.value = slider.id === "low" ? slider.min : slider.max;
      for (const event of ["input", "change"]) slider.dispatchEvent(new Event(event));
    });
    await settled(page);
    expect(await savedMission(page)).not.toContain("navigation");
    const before = await mission(page);
    for (const scene of ["{osm: other.osm}", "{osm: map.osm, without: [trees]}", "{mesh: map.osm}"]) {
      await open(page, { name: "other.yaml", text: `scene: ${scene}\ntarget: {osm: way/1}\nsensor: {max_range: 30}\n` });
      await expect(page.locator("#hint")).toContainText("another scene");
      expect(await mission(page)).toEqual(before);
      await page.keyboard.press("Escape");
    }
    await open(page, { name: "odd.yaml", text: "scene: {osm: map.osm}\ntarget: {osm: way/1}\nsensor: {max_rang: 30}\n" });
    await expect(page.locator("#hint")).toContainText("in sensor (line 3, column 10):");
    await open(page, { name: "own.yaml", text: "scene: {osm: maps/map.osm}\ntarget: {osm: way/1}\nsensor: {max_range: 30}\n" });
    await expect.poll(async () => (await mission(page)).range).toBe(30);
  } finally {
    viewer.kill("SIGINT");
  }
});

test("a report begins with the verdict, the place and the date, and lists every limit", async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), "vantage-"));
  const at = (id: number, east: number, north: number) => `<node id="${id}" version="1" lat="${48 + north / 111000}" lon="${11 + east / 74000}"/>`;
  writeFileSync(join(folder, "map.osm"), `<osm version="0.6">${at(1, 30, 0)}${at(2, 40, 0)}${at(3, 40, 10)}${at(4, 30, 10)}` +
    `<way id="1" version="1">${[1, 2, 3, 4, 1].map((n) => `<nd ref="${n}"/>`).join("")}<tag k="building" v="yes"/><tag k="height" v="9"/></way></osm>`);
  writeFileSync(join(folder, "m.yaml"), "scene: {osm: map.osm}\ntarget: {name: yard, outline: [[-20, 0], [-10, 0], [-10, 10]]}\nsensor: {max_range: 60}\n" +
    "navigation: {clearance: 3, keep_out: [{polygon: [[-9, -9], [-5, -9], [-5, -5]], z: [0, 20]}]}\n");
  const report = join(folder, "report.html");
  try {
    execFileSync(program, ["report", join(folder, "m.yaml"), "-o", report, "-q", "--page", join(root, "web/dist/report.html")], { stdio: "pipe" });
  } catch (error) {
    expect([1, 4]).toContain((error as { status: number }).status); // not all is proved
  }
  await page.goto(pathToFileURL(report).href);
  await hasVolume(page);
  await expect(page.locator("#verdict")).toHaveText(/^(Proved|Not proved)$/);
  await expect(page.locator("aside section").first()).toHaveId("summary");
  const facts = page.locator("#facts");
  for (const words of ["yard", "48.0", "N, 11.0", `${new Date().getUTCFullYear()}-`, "map.osm", "© OpenStreetMap contributors"]) {
    await expect(facts).toContainText(words);
  }
  await expect(page.locator("#limit-lines")).toContainText("3 m from all that is not ground");
  await expect(page.locator("#limit-lines")).toContainText("Keep out, zone 0");
  await expect(page.locator("#controls")).toBeHidden();
  await expect(page.locator("#credit")).toHaveText("© OpenStreetMap contributors");
  // A picture that is saved says it, too.
  await page.evaluate(() => {
    const { prototype } = CanvasRenderingContext2D;
    const write = prototype.fillText;
    (window as any).written = [];
    prototype.fillText = function (text: string, x: number, y: number) {
      (window as any).written.push(text);
      write.call(this, text, x, y);
    };
  });
  await saved(page, "picture");
  expect(await page.evaluate(() => (window as any).written)).toContain("© OpenStreetMap contributors");
});

test("a report shows the volume, and that it is proved, without an engine", async ({ page }) => {
  const report = join(mkdtempSync(join(tmpdir(), "vantage-")), "report.html");
  execFileSync(program, ["report", file, "-o", report, "-q", "--page", join(root, "web/dist/report.html")]);
  const problems: string[] = [];
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  page.on("pageerror", (error) => problems.push(String(error)));
  page.on("request", (request) => !/^(file|blob|data):/.test(request.url()) && problems.push(request.url()));
  await page.goto(pathToFileURL(report).href);
  await expect(page.locator("#proof")).toContainText("Proved");
  expect(Math.abs((await volume(page)) / byProgram(readFileSync(file, "utf8")) - 1)).toBeLessThan(1e-12);
  await expect(page.locator("#range")).toBeDisabled();
  await expect(page.locator("#verdict")).toHaveText("Proved");
  await expect(page.locator("#facts")).toContainText("not known: the scene does not say");
  expect(readFileSync(await saved(page, "picture")).length).toBeGreaterThan(1000);
  expect(problems).toEqual([]);
});
