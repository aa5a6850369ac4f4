// What the panel says of the volume: numbers, what bounds it, its cut, its proof.
import type { App } from "../app";
import type { Volume } from "../engine/client";
import type { VolumeInfo } from "../engine/messages";
import { KIND_COLOURS } from "../view/stage";
import { isAt, setEnds } from "./limits";
import { quantity } from "../model/quantity";
import { button, element, hex, input, large, metres, say, terms } from "./page";

const KIND_NAMES: Record<string, string> = {
  scene: "a building begins to hide it", range: "the longest range", target_plane: "the target's plane",
  navigation: "flight limits and boxes", sensor: "the camera", unknown: "not told by the file of the volume",
};

/** What each position of a volume sees: "all of the target". */
export function seenFrom({ claim }: VolumeInfo): string {
  const visible = claim?.visible ?? 1;
  // Rounded down: what is claimed is no more than what is so.
  const share = visible < 1 ? `at least ${Number((Math.floor(visible * 1000) / 10).toFixed(1))} %` : "all";
  return `${share} of ${claim?.combine === "any" ? "at least one of the targets" : "the target"}`;
}

export class Results {
  /** the volume that the proof is of */
  private judged: Volume | null = null;

  constructor(private readonly app: App) {
    input("cut").oninput = () => this.readCut();
    const field = input("cut-number");
    field.onfocus = () => field.select();
    field.onchange = () => this.typeCut(field.value);
    element<HTMLSelectElement>("cut-axis").onchange = () => {
      this.fitCut();
      input("cut").value = input("cut").max;
      this.readCut();
    };
    button("prove").onclick = () => void app.proveIt();
    app.onProof((text, volume) => {
      element("proof").textContent = text;
      this.judged = volume;
    });
    button("see").onclick = () => app.toggleEye();
    app.onChange(() => this.show());
  }

  private axis(): 0 | 1 | 2 {
    return Number(element<HTMLSelectElement>("cut-axis").value) as 0 | 1 | 2;
  }

  private fitCut(): void {
    const { scene } = this.app;
    if (!scene) return;
    const axis = this.axis();
    const slider = input("cut");
    const wasOff = this.app.cut === null;
    const size = Math.max(scene.max[0] - scene.min[0], scene.max[1] - scene.min[1]);
    if (slider.matches(":active")) return; // what is dragged must not move under the pointer
    const heights = axis === 2 && (this.app.volume?.info.facets ?? 0) > 0 ? this.app.volumeView.heights() : null;
    const [low, high] = heights ?? [scene.min[axis], scene.max[axis]];
    setEnds(slider, Math.floor(Math.log10((heights ? high - low : size) / 300)), low, high);
    slider.value = wasOff ? slider.max : String(this.app.cut!.at);
  }

  private typeCut(text: string): void {
    const at = /^\s*(off|any)?\s*$/.test(text) ? null : quantity(text, "length");
    if (at === null) this.app.setCut(null);
    else if (typeof at === "number") this.app.setCut({ axis: this.axis(), at });
    else say(`Cut: ${at}; or "off"`, true);
    input("cut-number").blur();
    this.show();
  }

  private readCut(): void {
    const slider = input("cut");
    this.app.setCut(isAt(slider, "max") ? null : { axis: this.axis(), at: Number(slider.value) });
    this.show();
  }

  private show(): void {
    const { volume, cut } = this.app;
    // Without a target there is no volume, and nothing to say of the last one.
    const section = volume && this.app.section;
    const failure = this.app.mission.target ? this.app.failure : "";
    this.fitCut();
    const field = input("cut-number");
    if (field !== document.activeElement) field.value = cut === null ? "off" : `${Number(cut.at.toPrecision(12))} m`;
    element("cut-out").textContent = section && cut?.axis === 2 ? `area ${large(section.area_m2)} m²` : "";
    const status = element("status");
    status.classList.toggle("bad", failure !== "");
    const shown = volume ? ": the volume shown is that of the last valid target" : "";
    status.textContent = this.app.wasStopped ? `Not computed, since it was stopped${volume ? ": the volume shown is the last one" : ""}`
      : failure !== "" ? `There is no volume of this target${shown}`
      : !volume ? "No target yet" : volume.info.outcome === "computed" ? "" : volume.info.reason;
    element("claim").textContent = volume && volume.info.outcome !== "computed" ? ""
      : `Every position in the volume sees ${volume ? seenFrom(volume.info) : "all of the target"}.`;
    this.showNumbers();
    this.showLegend();
    element("notes").replaceChildren(...(volume?.info.notes ?? []).map(({ text }) => {
      const item = document.createElement("li");
      item.textContent = text;
      return item;
    }));
    this.showAllLimits();
    element("credit").textContent = this.app.scene?.attribution ?? "";
    element("credit").hidden = element("credit").textContent === "";
    button("prove").disabled = button("save").disabled = button("link").disabled = !volume;
    button("see").disabled = !this.app.probe;
    button("see").setAttribute("aria-pressed", String(this.app.isEye()));
    if (volume !== this.judged) element("proof").textContent = "";
  }

  /** Also those that the page has no controls for. Of the volume that is shown. */
  private showAllLimits(): void {
    const lines = this.app.volume?.info.limits.all ?? [];
    element("all-limits").hidden = lines.length === 0;
    element("limit-lines").replaceChildren(...terms(lines.map(({ name, text }) => [name, text])));
  }

  private showNumbers(): void {
    const { volume, scene } = this.app;
    const rows: [string, string][] = [];
    if (volume) {
      const [low, high] = this.app.volumeView.heights();
      rows.push(["Volume", `${large(volume.info.volume_m3)} m³`]);
      if (volume.info.facets > 0) rows.push(["Heights", `${metres(low)} to ${metres(high)}`]);
      rows.push(["Facets", `${large(volume.info.facets)}${this.app.isDraft ? ", while it is dragged" : ""}`]);
      // Not of a volume that was read from a file.
      if (volume.info.compute_ms > 0) rows.push(["Computed in", `${Math.max(0.1, volume.info.resolve_ms + volume.info.compute_ms).toFixed(1)} ms`]);
    }
    if (scene) rows.push(["Scene", `${large(scene.triangles)} triangles`]);
    element("numbers").replaceChildren(...terms(rows));
  }

  private showLegend(): void {
    const areas = this.app.volume ? this.app.volumeView.areaOfKind() : new Map<string, number>();
    const whole = [...areas.values()].reduce((a, b) => a + b, 0);
    element("legend").replaceChildren(...[...areas].sort((a, b) => b[1] - a[1]).map(([kind, area]) => {
      const item = document.createElement("li");
      const swatch = document.createElement("i");
      swatch.style.background = hex(KIND_COLOURS[kind] ?? 0);
      const share = (100 * area) / whole;
      item.append(swatch, `${KIND_NAMES[kind] ?? kind}, ${share < 1 ? "< 1" : Math.round(share)} %`);
      return item;
    }));
  }
}
