// The page that the program serves, and the reports that it writes.
import { expect, test } from "@playwright/test";
import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { byProgram, drag, hasVolume, mission, plaza, program, root, saved, savedMission, settled, volume } from "./support";

const file = join(plaza, "mission.yaml");
let server: ChildProcess;
let address: string;

test.describe("vantage view", () => {
  test.beforeEach(async () => {
    server = spawn(program, ["view", file, "--no-browser", "--page", join(root, "web/dist/index.html")]);
    address = await new Promise((resolve, reject) => {
      server.stdout!.once("data", (text: Buffer) => resolve(text.toString().trim()));
      server.once("exit", (code) => reject(new Error(`the program ended with ${code}`)));
    });
  });
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

  test("says that the program has ended, and keeps the mission", async ({ page }) => {
    await page.goto(address);
    await hasVolume(page);
    const ended = new Promise((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    expect(await ended).toBe(0);
    await expect(page.locator("#hint")).toContainText("has ended");
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
  expect(readFileSync(await saved(page, "picture")).length).toBeGreaterThan(1000);
  expect(problems).toEqual([]);
});
