// Shows a tileset in CesiumJS, in Debian's Chromium, and compares what is picked with what was expected.
//   node check.mjs FOLDER.tiles PICKS.json PICTURE.png
// PICKS.json is made by picks.py. Exit code 1 where anything differs. Nothing outside of this machine is asked.
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { fileURLToPath } from "node:url";
import validator from "gltf-validator";
import { chromium } from "playwright-core";

const here = path.dirname(fileURLToPath(import.meta.url));
const [folder, picksFile, picture] = process.argv.slice(2);
if (!picture) {
  console.error("usage: node check.mjs FOLDER.tiles PICKS.json PICTURE.png");
  process.exit(2);
}
const FARTHEST_M = 0.05;  // of a picked place from the expected one: the depth buffer's
const failures = [];
const check = (is_right, text) => { if (!is_right) failures.push(text); };

async function validate() {
  const file = path.join(folder, "volume.glb");
  const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: file, maxIssues: 0 });
  console.log(`gltf-validator ${validator.version()}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ` +
    `${issues.numInfos} infos, ${issues.numHints} hints`);
  for (const message of issues.messages) console.log(`  ${message.code} ${message.pointer ?? ""} ${message.message}`);
  check(issues.numErrors === 0 && issues.numWarnings === 0, "gltf-validator finds faults");
}

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".json": "application/json",
  ".css": "text/css", ".glb": "model/gltf-binary", ".wasm": "application/wasm", ".png": "image/png" };

// "/cesium/..." is CesiumJS, "/tiles/..." the tileset, all else this folder.
function file_of(address) {
  const wanted = decodeURIComponent(new URL(address, "http://localhost").pathname);
  const [root, rest] = wanted.startsWith("/cesium/") ? [path.join(here, "node_modules/cesium/Build/Cesium"), wanted.slice(8)]
    : wanted.startsWith("/tiles/") ? [path.resolve(folder), wanted.slice(7)] : [here, wanted.slice(1)];
  const file = path.join(root, rest);
  return file.startsWith(root + path.sep) ? file : null;
}

const server = http.createServer((request, response) => {
  const file = file_of(request.url);
  if (!file || !fs.existsSync(file) || !fs.statSync(file).isFile()) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200, { "content-type": TYPES[path.extname(file)] ?? "application/octet-stream" });
  fs.createReadStream(file).pipe(response);
});

async function show(origin) {
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  try {
    const page = await browser.newPage({ viewport: { width: 900, height: 600 } });
    page.setDefaultTimeout(180_000);
    page.on("pageerror", (error) => failures.push(`the page fails: ${error}`));
    await page.route(/.*/, (route) => {
      const address = route.request().url();
      const is_local = [origin, "blob:", "data:"].some((start) => address.startsWith(start));
      if (!is_local) failures.push(`the page asks for ${address}`);
      return is_local ? route.continue() : route.abort();
    });
    await page.goto(`${origin}/page.html`);
    await page.waitForFunction(() => window.ready);
    console.log(`CesiumJS ${await page.evaluate(async () => {
      window.view = await window.View.open("/tiles/tileset.json");
      return window.Cesium.VERSION;
    })}`);
    await pick_all(page);
    const shown = await page.evaluate(() => window.view.overview());
    await page.screenshot({ path: picture });
    console.log(`picture: ${picture}, the tileset's sphere has ${shown.radius.toFixed(1)} m`);
  } finally {
    await browser.close();
  }
}

async function pick_all(page) {
  const expected = JSON.parse(fs.readFileSync(picksFile, "utf8"));
  check(expected.length >= 10, "fewer than ten places to pick");
  let farthest = 0;
  for (const [number, want] of expected.entries()) {
    const got = await page.evaluate(([from, at]) => window.view.pick(from, at, 1), [want.from, want.at]);
    const off = got.place ? Math.hypot(...got.place.map((value, i) => value - want.at[i])) : Infinity;
    farthest = Math.max(farthest, off);
    console.log(`pick ${number}: ${got.kind} '${got.name}' ${got.area_m2?.toFixed(3)} m2, pixel of ${got.pixel}, ` +
      `${off.toFixed(4)} m off`);
    const place = `pick ${number}, ${want.kind} '${want.name}'`;
    check(got.kind === want.kind && got.name === want.name, `${place}: Cesium has ${got.kind} '${got.name}'`);
    check(Math.abs(got.area_m2 - want.area_m2) <= 1e-6 * want.area_m2, `${place}: its area is ${got.area_m2}`);
    check(got.pixel === want.kind, `${place}: it has the colour of ${got.pixel}`);
    check(off <= FARTHEST_M, `${place}: it is ${off} m off`);
  }
  console.log(`${expected.length} picks, at most ${farthest.toFixed(4)} m off`);
}

await validate();
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
try {
  await show(`http://127.0.0.1:${server.address().port}`);
} finally {
  server.close();
}
for (const failure of failures) console.error(`check.mjs: ${failure}`);
process.exitCode = failures.length > 0 ? 1 : 0;
