// Makes docs/flight/page.png: the tour of the invented town, in the page that `vantage view` serves.
//   make web build && (cd web && node picture_of_flight.mjs)
import { chromium } from "@playwright/test";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("..", import.meta.url));
const program = process.env.VANTAGE ?? join(root, "build/bin/vantage");
const mission = join(root, "examples/town/tour.yaml");
const plan = join(mkdtempSync(join(tmpdir(), "vantage-")), "tour.plan");
execFileSync(program, ["tour", mission, "-o", plan, "-q"], { stdio: "inherit" });
const viewer = spawn(program, ["view", mission, "--flight", plan, "--no-browser", "--page", join(root, "web/dist/index.html")]);
const address = await new Promise((resolve) => viewer.stdout.once("data", (text) => resolve(text.toString().trim())));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 860 } });
  await page.goto(address);
  await page.waitForSelector("#flight:not([hidden])");
  await page.check("#flight-volumes");
  await page.waitForSelector("#flight-rows .row-name i");
  await page.waitForFunction(() => document.body.ariaBusy === "false" && !window.vantage.isLate());
  await page.evaluate(() => {
    const { flights, stage } = window.vantage;
    window.vantage.showAll();
    stage.turn(0, 14, 0.5);
    const [begin, end] = flights.flight.targets[1].seen[0];
    flights.flyTo((begin + end) / 2);
    document.getElementById("hint").hidden = true;
  });
  await page.waitForTimeout(1000);
  await page.screenshot({ path: join(root, "docs/flight/page.png") });
} finally {
  await browser.close();
  viewer.kill("SIGINT");
}
