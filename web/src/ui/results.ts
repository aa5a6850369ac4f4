// What the panel says of the volume: numbers, what bounds it, its cut, its proof.
import type { App } from "../app";
import type { Volume } from "../engine/client";
import type { Ledger } from "../engine/messages";
import { large, quantity } from "../model/quantity";
import { ledgerLine, ledgerText } from "../model/ledger";
import { boundaryShares, claimText, volumeNumbers } from "../model/volume";
import { KIND_COLOURS } from "../view/stage";
import { isAt, setEnds } from "./limits";
import { button, element, hex, input, showMessage, terms } from "./page";

const LISTED = 20;

export class Results {
  /** the volume that the proof is of */
  private judged: Volume | null = null;
  private listed: Ledger | undefined;

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
    else showMessage(`Cut: ${at}; or "off"`, true);
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
    element("claim").textContent = volume ? claimText(volume.info) : "Every position in the volume sees all of the target.";
    this.showNumbers();
    this.showLegend();
    element("notes").replaceChildren(...(volume?.info.notes ?? []).map(({ text }) => {
      const item = document.createElement("li");
      item.textContent = text;
      return item;
    }));
    this.showAllLimits();
    this.showLedger();
    element("credit").textContent = this.app.scene?.attribution ?? "";
    element("credit").hidden = element("credit").textContent === "";
    button("prove").disabled = button("save").disabled = button("link").disabled = !volume;
    button("see").disabled = !this.app.probe;
    button("see").setAttribute("aria-pressed", String(this.app.isEye()));
    if (volume !== this.judged) element("proof").textContent = "";
  }

  /** Also those that the page has no controls for. */
  private showAllLimits(): void {
    const lines = this.app.said?.limits.all ?? [];
    element("all-limits").hidden = lines.length === 0;
    element("limit-lines").replaceChildren(...terms(lines.map(({ name, text }) => [name, text])));
  }

  /** What the scene's source has, and the scene has not as it stands. */
  private showLedger(): void {
    const { ledger } = this.app.scene ?? {};
    if (ledger === this.listed) return;
    this.listed = ledger;
    element("ledger").hidden = !ledger || ledger.count === 0;
    if (!ledger) return;
    element("ledger-count").textContent = ledgerText(ledger);
    const shown = ledger.worst.slice(0, LISTED);
    const lines = shown.map(ledgerLine);
    if (ledger.count > shown.length) lines.push(`and ${ledger.count - shown.length} more: vantage inspect lists all`);
    element("ledger-list").replaceChildren(...lines.map((text) => {
      const item = document.createElement("li");
      item.textContent = text;
      return item;
    }));
  }

  private showNumbers(): void {
    const { volume, scene } = this.app;
    const rows = volume ? volumeNumbers(volume.info, this.app.volumeView.heights(), this.app.isDraft) : [];
    if (scene) rows.push(["Scene", `${large(scene.triangles)} triangles`]);
    element("numbers").replaceChildren(...terms(rows));
  }

  private showLegend(): void {
    const areas = this.app.volume ? this.app.volumeView.areaOfKind() : new Map<string, number>();
    element("legend").replaceChildren(...boundaryShares(areas).map(({ kind, text }) => {
      const item = document.createElement("li");
      const swatch = document.createElement("i");
      swatch.style.background = hex(KIND_COLOURS[kind] ?? 0);
      item.append(swatch, text);
      return item;
    }));
  }
}
