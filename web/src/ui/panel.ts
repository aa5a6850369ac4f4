// The sliders beside the view: what limits the view.
import type { App } from "../app";
import type { About } from "../engine/messages";
import type { Mission } from "../model/mission";
import { button, element, input, metres, option } from "./page";

const PIXELS_M = [0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];
const NO_TILT = 5; // the slider's end, beyond level

export class Panel {
  constructor(private readonly app: App, about: About) {
    this.slider("range", (mission, value) => (mission.range = Math.max(Number(input("range").step), value)));
    this.slider("near", (mission, value) => (mission.minRange = Math.min(value, mission.range * 0.9)));
    this.slider("low", (mission) => (mission.altitude = this.altitude()));
    this.slider("high", (mission) => (mission.altitude = this.altitude()));
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

  private altitude(): [number, number] | null {
    const low = input("low");
    const high = input("high");
    if (low.value === low.min && high.value === high.max) return null;
    return [Number(low.value), Math.max(Number(low.value) + Number(low.step), Number(high.value))];
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
  }

  private show(): void {
    this.fit();
    const { mission } = this.app;
    const set = (id: string, value: number, text: string) => {
      if (!input(id).matches(":active")) input(id).value = String(value);
      element(`${id}-out`).textContent = text;
      input(id).setAttribute("aria-valuetext", text);
    };
    const [low, high] = mission.altitude ?? [null, null];
    set("range", mission.range, metres(mission.range));
    set("near", mission.minRange, mission.minRange > 0 ? metres(mission.minRange) : "any");
    set("low", low ?? Number(input("low").min), low === null ? "any" : metres(low));
    set("high", high ?? Number(input("high").max), high === null ? "any" : metres(high));
    set("slant", mission.incidence ?? 90, mission.incidence === null ? "any" : `${mission.incidence}°`);
    set("tilt", mission.tilt ?? NO_TILT, mission.camera === null ? "no camera" : mission.tilt === null ? "a gimbal" : `${mission.tilt}°`);
    this.choose("camera", mission.camera, "as in the file");
    this.choose("pixel", mission.pixel, metres(mission.pixel ?? 0));
    input("tilt").disabled = input("pixel").disabled = mission.camera === null;
    this.showBoxes();
  }

  /** A choice that only the file has is added. */
  private choose(id: string, value: string | number | null, text: string): void {
    const select = element<HTMLSelectElement>(id);
    const wanted = value === null ? "" : String(value);
    if (![...select.options].some((one) => one.value === wanted)) select.append(option(wanted, text));
    select.value = wanted;
  }

  private showBoxes(): void {
    const list = element("boxes");
    if (list.contains(document.activeElement) && list.childElementCount === this.app.mission.keepOut.length) return; // is typed into
    list.replaceChildren(...this.app.mission.keepOut.map((box, i) => {
      const item = document.createElement("li");
      for (const [end, name] of [["min", "from"], ["max", "to"]] as const) {
        item.append(name);
        ["x", "y", "z"].forEach((axis, a) => {
          const field = document.createElement("input");
          field.type = "number";
          field.step = input("range").step;
          field.value = String(Number(box[end][a]!.toFixed(3)));
          field.setAttribute("aria-label", `box ${i + 1}, ${name} ${axis}, metres`);
          field.onchange = () => this.app.edit((mission) => {
            const { min, max } = mission.keepOut[i]!;
            const other = end === "min" ? max[a]! : min[a]!;
            [min[a], max[a]] = [Math.min(other, Number(field.value)), Math.max(other, Number(field.value))];
          }, true);
          item.append(field);
        });
      }
      const remove = document.createElement("button");
      remove.textContent = "Remove";
      remove.onclick = () => this.app.edit((mission) => mission.keepOut.splice(i, 1), true);
      item.append(remove);
      return item;
    }));
  }
}
