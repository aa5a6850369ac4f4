// The example, bundled by esbuild, in Chromium: the bytes of the program.
import { expect, test } from "@playwright/test";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, readFileSync } from "node:fs";
import { createServer, type Server } from "node:http";
import { join } from "node:path";
import { byProgram, noProgram, plaza, root } from "./support.mjs";

const example = join(root, "web/npm/example");
const types: Record<string, string> = { html: "text/html", js: "text/javascript", wasm: "application/wasm" };
let server: Server;
let address = "";

test.beforeAll(async () => {
  execFileSync("node", [join(example, "build.mjs")]);
  server = createServer((request, response) => {
    const file = join(example, "dist", request.url === "/" ? "index.html" : request.url!.slice(1));
    if (!existsSync(file)) return void response.writeHead(404).end();
    response.writeHead(200, { "Content-Type": types[file.split(".").at(-1)!] }).end(readFileSync(file));
  });
  await new Promise<void>((ready) => server.listen(0, "127.0.0.1", ready));
  const bound = server.address();
  address = typeof bound === "object" && bound ? `http://127.0.0.1:${bound.port}/` : "";
});
test.afterAll(() => server.close());

test("the example computes in a worker", async ({ page }) => {
  test.skip(Boolean(noProgram), String(noProgram));
  const mission = join(root, "examples/plaza/mission.yaml");
  await page.goto(address);
  await page.locator("input").setInputFiles([mission, plaza]);
  await expect(page.locator("pre")).not.toBeEmpty({ timeout: 60_000 });
  const told = JSON.parse((await page.locator("pre").textContent())!);
  const expected = byProgram(readFileSync(mission, "utf8"), plaza);
  expect(told.ply_sha256).toBe(createHash("sha256").update(expected).digest("hex"));
});
