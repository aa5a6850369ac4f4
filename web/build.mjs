// Makes dist/index.html: one file with script, style, worker, engine and example, which asks for no other; and
// dist/report.html, the same without the engine, which `vantage report` fills.
//   VANTAGE_ENGINE: the folder with vantage.js and vantage.wasm (scripts/build_web.sh makes it)
import { build } from "esbuild";
import { readFileSync, mkdirSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const engine = process.env.VANTAGE_ENGINE ?? "../build-web";
const example = "../examples/plaza";

async function bundle(entry, define = {}) {
  const made = await build({
    entryPoints: [entry], bundle: true, minify: true, write: false, format: "iife", target: "es2021", define,
    legalComments: "none",
  });
  return made.outputFiles[0].text;
}

/// A script must not end where a text in it has the end of a script.
const inScript = (text) => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");

const worker = readFileSync(`${engine}/vantage.js`, "utf8") + "\n" + (await bundle("src/engine/worker.ts"));
const script = await bundle("src/main.ts");
const style = readFileSync("src/style.css", "utf8");
const data = {
  worker,
  wasm: gzipSync(readFileSync(`${engine}/vantage.wasm`), { level: 9 }).toString("base64"),
  mesh: readFileSync(`${example}/plaza.obj`, "utf8"),
  mission: readFileSync(`${example}/mission.yaml`, "utf8"),
};
/// Whose work is in the page, as their licences ask.
const notices = [
  "../LICENSE", "../THIRD-PARTY-NOTICES.txt", "node_modules/three/LICENSE", "node_modules/yaml/LICENSE",
  "../.deps/web/yaml-cpp/LICENSE", "../.deps/web/zlib/README",
].map((file) => `${file.replace(/^.*(three|yaml|yaml-cpp|zlib)\//, "$1: ").replace("../", "")}\n\n${readFileSync(file, "utf8").trim()}`)
  .join(`\n\n${"-".repeat(80)}\n\n`);
const asText = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
const template = readFileSync("src/index.html", "utf8")
  .replace("/*STYLE*/", () => style)
  .replace("<!--NOTICES-->", () => asText(notices))
  .replace("/*SCRIPT*/", () => inScript(script));
/// A report asks nobody for anything. (The page with an engine would need words that older browsers do not know.)
const reportPolicy = `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; ` +
  `style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'">`;
mkdirSync("dist", { recursive: true });
for (const [name, own] of [["index.html", `window.vantageData = ${inScript(JSON.stringify(data))};`], ["report.html", ""]]) {
  const page = template.replace("/*DATA*/", () => own).replace("<!--POLICY-->", own ? "" : reportPolicy);
  writeFileSync(`dist/${name}`, page);
  console.log(`${name}: ${page.length} bytes, ${gzipSync(page, { level: 9 }).length} gzipped`);
}
