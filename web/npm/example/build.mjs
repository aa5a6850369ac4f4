// Bundles the example into example/dist with esbuild: page, worker, and the engine beside them.
//   node build.mjs
import { build } from "esbuild";
import { copyFileSync, mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
mkdirSync(here("dist"), { recursive: true });
await build({
  entryPoints: [here("page.ts"), here("worker.ts")], outdir: here("dist"), bundle: true, minify: true, format: "esm", target: "es2021",
});
// esbuild leaves the address of the engine's file as it is: it lies beside the script.
copyFileSync(createRequire(import.meta.url).resolve("vantage-engine/vantage.wasm"), here("dist/vantage.wasm"));
copyFileSync(here("index.html"), here("dist/index.html"));
