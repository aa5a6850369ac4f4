// The sliders beside the view: what limits the view.
import type { App } from "../app";
import type { About, Box } from "../engine/messages";
import { rounded, type Mission } from "../model/mission";
import { button, element, input, metres, option } from "./page";

const PIXELS_M = [0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];
const NO_TILT = 5; // the slider's end, beyond level

export class Panel {
  constructor(private readonly app: App, about: About) {
    this.slider("range", (mission, value) => (mission.range = Math.max(Number(input("range").step), value)));
    this.slider("near", (mission, value) => (mission.minRange = Math.min(value, mission.range * 0.9)));
    for (const id of ["low", "high"]) this.slider(id, (mission) => (mission.altitude = band("low", "high")));
    for (const id of ["low-agl", "high-agl"]) this.slider(id, (mission) => (mission.agl = band("low-agl", "high-agl")));
    this.slider("slant", (mission, value) => (mission.incidence = value >= 90 ? null : value));
    this.slider("tilt", (mission, value) => (mission.tilt = value >= NO_TILT ? null : value));
    const camera = input("camera");
    camera.append(option("", "any"), ...about.cameras.map(({ name, maker, model }) => option(name, `${maker} ${model}`)));
    camera.onchange = () => app.edit((mission) => this.setCamera(mission, camera.value), true);
    const pixel = input("pixel");
    pixel.append(option("", "any"), ...PIXELS_M.map((size) => option(String(size), size < 0.01 ? `${size * 1e3} mm` : `${size * 100} cm`)));
    pixel.onchange = () => app.edit((mission) => (mission.pixel = pixel.value === "" ? null : Number(pixel.value)), true);
    button("add-box").onclick = () => this.addBox();
    app.onChange(() => this.show());
  }

  private slider(id: string, change: (mission: Mission, value: number) => void): void {
    const slider = input(id);
    slider.oninput = () => this.app.edit((mission) => change(mission, Number(slider.value)), false);
    slider.onchange = () => this.app.keep();
  }

  private setCamera(mission: Mission, name: string): void {
    mission.camera = name === "" ? null : name;
    if (name === "") mission.tilt = mission.pixel = null;
  }

  /** Between the target and the range, to the east. */
  private addBox(): void {
    const { volume, scene, mission } = this.app;
    if (!scene) return;
    const step = Number(input("range").step);
    const whole = (value: number) => Math.round(value / step) * step;
    const [x, y, z] = volume?.info.center ?? [(scene.min[0] + scene.max[0]) / 2, (scene.min[1] + scene.max[1]) / 2, scene.min[2]];
    const half = whole(Math.max(2 * step, mission.range / 10));
    const [east, north, low] = [whole(x + mission.range / 3), whole(y), whole(z)];
    this.app.edit(({ keepOut }) => keepOut.push({
      min: [east - half, north - half, low], max: [east + half, north + half, low + 4 * half],
    }), true);
  }

  /** Limits of the sliders, for a new scene. */
  private fit(): void {
    const { scene, mission } = this.app;
    if (!scene) return;
    const size = Math.max(scene.max[0] - scene.min[0], scene.max[1] - scene.min[1]);
    const step = 10 ** Math.floor(Math.log10(size / 60));
    const ends = (id: string, low: number, high: number) => {
      input(id).step = String(step);
      input(id).min = String(Math.floor(low / step) * step);
      input(id).max = String(Math.ceil(high / step) * step);
    };
    ends("range", 0, Math.max(size, mission.range, mission.opened.range));
    ends("near", 0, Math.max(size / 4, mission.minRange));
    const top = Math.max(scene.max[2] + size / 3, mission.altitude?.[1] ?? -Infinity);
    for (const id of ["low", "high"]) ends(id, Math.min(scene.min[2], mission.altitude?.[0] ?? Infinity), top);
    const above = Math.max(scene.max[2] - scene.min[2] + size / 3, mission.agl?.[1] ?? -Infinity);
    for (const id of ["low-agl", "high-agl"]) ends(id, Math.min(0, mission.agl?.[0] ?? 0), above);
    for (const label of document.querySelectorAll<HTMLElement>(".agl")) label.hidden = !scene.has_ground && !mission.hasGround;
  }

  private show(): void {
    this.fit();
    const { mission } = this.app;
    const set = (id: string, value: number, text: string) => {
      if (!input(id).matches(":active")) input(id).value = String(value);
      element(`${id}-out`).textContent = text;
      input(id).setAttribute("aria-valuetext", text);
    };
    const showBand = (from: string, to: string, [low, high]: [number, number] | [null, null]) => {
      set(from, low ?? Number(input(from).min), low === null ? "any" : metres(low));
      set(to, high ?? Number(input(to).max), high === null ? "any" : metres(high));
    };
    set("range", mission.range, metres(mission.range));
    set("near", mission.minRange, mission.minRange > 0 ? metres(mission.minRange) : "any");
    showBand("low", "high", mission.altitude ?? [null, null]);
    showBand("low-agl", "high-agl", mission.agl ?? [null, null]);
    set("slant", mission.incidence ?? 90, mission.incidence === null ? "any" : `${mission.incidence}°`);
    set("tilt", mission.tilt ?? NO_TILT, mission.camera === null ? "no camera" : mission.tilt === null ? "a gimbal" : `${mission.tilt}°`);
    this.choose("camera", mission.camera, mission.opened.camera, () => "as in the file");
    this.choose("pixel", mission.pixel, mission.opened.pixel, (size) => metres(Number(size)));
    input("tilt").disabled = input("pixel").disabled = mission.camera === null;
    this.showBoxes();
  }

  /** A choice that only the file has is added, as long as that file is open. */
  private choose(id: string, value: string | number | null, opened: string | number | null, text: (value: string) => string): void {
    const select = element<HTMLSelectElement>(id);
    const [wanted, own] = [value, opened].map((one) => (one === null ? "" : String(one))) as [string, string];
    for (const one of [...select.options]) if ("own" in one.dataset && one.value !== wanted && one.value !== own) one.remove();
    for (const one of [wanted, own]) {
      if ([...select.options].some((other) => other.value === one)) continue;
      const added = option(one, text(one));
      added.dataset["own"] = "";
      select.append(added);
    }
    select.value = wanted;
  }

  private showBoxes(): void {
    const list = element("boxes");
    const { keepOut } = this.app.mission;
    if (list.childElementCount !== keepOut.length) list.replaceChildren(...keepOut.map((_, i) => this.rowOfBox(i)));
    list.querySelectorAll("input").forEach((field, i) => {
      if (field !== document.activeElement) field.value = this.coordinate(i);
    });
  }

  /** Of the field with this index in the list of boxes. */
  private coordinate(field: number): string {
    const { keepOut, grain } = this.app.mission;
    const { min, max } = keepOut[Math.floor(field / 6)]!;
    return String(rounded([...min, ...max][field % 6]!, grain));
  }

  private rowOfBox(i: number): HTMLElement {
    const item = document.createElement("li");
    for (const [end, name] of [["min", "from"], ["max", "to"]] as const) {
      item.append(name);
      ["x", "y", "z"].forEach((axis, a) => {
        const field = document.createElement("input");
        field.type = "number";
        field.step = "any";
        field.setAttribute("aria-label", `box ${i + 1}, ${name} ${axis}, metres`);
        field.onchange = () => {
          // What is not a number is empty.
          if (field.value !== "") this.app.edit((mission) => moveEnd(mission.keepOut[i]!, end, a, Number(field.value)), true);
          field.value = this.coordinate(6 * i + (end === "min" ? a : 3 + a));
        };
        item.append(field);
      });
    }
    const remove = document.createElement("button");
    remove.textContent = "Remove";
    remove.onclick = () => this.app.edit((mission) => mission.keepOut.splice(i, 1), true);
    item.append(remove);
    return item;
  }
}

/** What two sliders say; null: each is at its end. */
function band(from: string, to: string): [number, number] | null {
  const [low, high] = [input(from), input(to)];
  if (low.value === low.min && high.value === high.max) return null;
  return [Number(low.value), Math.max(Number(low.value) + Number(low.step), Number(high.value))];
}

/** Ends that come to lie the wrong way round change places. */
function moveEnd({ min, max }: Box, end: "min" | "max", axis: number, value: number): void {
  const other = end === "min" ? max[axis]! : min[axis]!;
  [min[axis], max[axis]] = [Math.min(other, value), Math.max(other, value)];
}
