// Beside the view: what limits it.
import type { App } from "../app";
import type { About } from "../engine/messages";
import type { Mission } from "../model/mission";
import { metres } from "../model/quantity";
import { BoxList } from "./box_list";
import { Limits } from "./limits";
import { element, input, option } from "./page";

const PIXELS_M = [0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001];

export class Panel {
  constructor(private readonly app: App, about: About) {
    new Limits(app);
    new BoxList(app);
    const camera = input("camera");
    camera.append(option("", "any"), ...about.cameras.map(({ name, maker, model }) => option(name, `${maker} ${model}`)));
    camera.onchange = () => app.edit((mission) => this.setCamera(mission, camera.value), true);
    const pixel = input("pixel");
    pixel.append(option("", "any"), ...PIXELS_M.map((size) => option(String(size), size < 0.01 ? `${size * 1e3} mm` : `${size * 100} cm`)));
    pixel.onchange = () => app.edit((mission) => this.setPixel(mission, pixel.value === "" ? null : Number(pixel.value)), true);
    const formats = input("format");
    formats.prepend(...about.formats.map((format) => option(format, format)));
    formats.value = about.formats.includes("glb") ? "glb" : about.formats[0] ?? "mission"; // it has the colours of the page
    app.onChange(() => this.show());
  }

  private setCamera(mission: Mission, name: string): void {
    mission.camera = name === "" ? null : name;
    if (name !== "") return;
    mission.tilt = null;
    this.setPixel(mission, null);
  }

  /** Where the range followed from the pixels, it stays what it was. */
  private setPixel(mission: Mission, size: number | null): void {
    mission.pixel = size;
    if (size !== null || mission.maxRange !== null || mission.hasPilot) return;
    mission.maxRange = mission.range = this.app.volume?.info.range_m ?? mission.range;
  }

  private show(): void {
    const { mission } = this.app;
    this.choose("camera", mission.camera, mission.opened.camera, () => "as in the file");
    this.choose("pixel", mission.pixel, mission.opened.pixel, (size) => metres(Number(size)));
    input("pixel").disabled = !this.app.canEdit || mission.camera === null;
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
}
