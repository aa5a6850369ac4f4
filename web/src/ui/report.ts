// A page that the program wrote as a report: to look at, without an engine.
import type { App } from "../app";
import type { Hello } from "../engine/messages";
import { element, option } from "./page";

/** Leaves what needs no engine: the view, the cut along an axis, the picture. */
export function makeReport(app: App, hello: Hello): void {
  const panel = document.querySelector("aside section")!;
  for (const control of panel.querySelectorAll<HTMLInputElement>("input, select, button")) control.disabled = true;
  element<HTMLSelectElement>("format").replaceChildren(option("picture", "picture"), option("mission", "mission"));
  const name = app.volume?.info.name ?? "";
  element("title").textContent = name === "" ? hello.name : name;
  void app.proveIt();
}
