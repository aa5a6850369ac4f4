// A page that the program wrote as a report: to look at, without an engine. It begins with what was found, where and when.
import type { App } from "../app";
import type { Hello, Proof, SceneInfo } from "../engine/messages";
import { emptyText } from "../model/volume";
import { element, option, terms } from "./page";

/** As of a map: the program's numbers have as many digits. */
function placeText({ place }: SceneInfo): string {
  if (!place) return "not known: the scene does not say where on the earth it lies";
  const side = (value: number, names: string) => `${Math.abs(value).toFixed(6)}\u00b0 ${names[value < 0 ? 1 : 0]}`;
  const heights = place.vertical === "" ? "" : `; heights above ${place.vertical}`;
  return `${side(place.latitude_deg, "NS")}, ${side(place.longitude_deg, "EW")}, the origin of the scene${heights}`;
}

const VERDICTS: Record<string, string> = { proved: "Proved", wrong: "Wrong", "not proved": "Not proved" };

function show(app: App, text: string, proof?: Proof): void {
  const info = app.volume?.info;
  const isEmpty = info !== undefined && info.outcome !== "computed";
  const title = element("verdict");
  const isProved = proof?.verdict === "proved";
  title.textContent = isEmpty ? "No volume" : proof === undefined ? "No proof" : (VERDICTS[proof.verdict] ?? proof.verdict);
  title.className = isEmpty || proof === undefined ? "" : isProved ? "good" : "bad";
  element("claim").hidden = isEmpty || (proof !== undefined && !isProved);
  const open = (proof?.claims ?? []).filter(({ verdict }) => verdict !== "proved").map((one) => `${one.name}: ${one.verdict}: ${one.text}`);
  element("verdict-text").textContent = isEmpty ? emptyText(info) : isProved ? text : open.join(". ") || text;
}

/** Leaves what needs no engine: the view, the cut along an axis, the picture. `made`: the day. */
export function makeReport(app: App, hello: Hello, made: string): void {
  const controls = element("controls");
  for (const control of controls.querySelectorAll<HTMLInputElement>("input, select, button")) control.disabled = true;
  controls.hidden = true;
  element("summary").hidden = false;
  const panel = element("all-limits").parentElement!;
  panel.insertBefore(element("volume"), element("all-limits"));
  element<HTMLSelectElement>("format").replaceChildren(option("picture", "picture"), option("mission", "mission"));
  const name = app.volume?.info.name ?? "";
  element("title").textContent = name === "" ? hello.name : name;
  element("facts").replaceChildren(...terms([
    ["Target", name === "" ? "not named" : name], ["Place", placeText(hello.scene)], ["Date", `${made}, UTC`], ["Mission", hello.name],
    ["Scene", app.source.name], ["Made by", `vantage ${hello.about.version}`],
    ...(hello.scene.attribution === "" ? [] : [["Map data", hello.scene.attribution] as [string, string]]),
  ]));
  app.onProof((text, _volume, proof) => show(app, text, proof));
  show(app, "");
  void app.proveIt();
}
