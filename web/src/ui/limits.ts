// Sliders, and beside each the number that it stands for, to be typed.
import type { App } from "../app";
import type { Band } from "../model/heights";
import type { Mission } from "../model/mission";
import { metres, quantity } from "../model/quantity";
import { input, showMessage } from "./page";

/** null: no limit. */
interface Limit {
  name: string;
  get(mission: Mission): number | null;
  set(mission: Mission, value: number | null): void;
  /** the end of the slider that means no limit */
  open?: "min" | "max";
  unit?: "degrees";
  text?(mission: Mission): string;
}

/**
 * Ends of a slider, about these two, as multiples of its step, 10 to the power of `exponent`: browsers keep the value to
 * steps, and an end between two of them cannot be reached.
 */
export function setEnds(slider: HTMLInputElement, exponent: number, low: number, high: number): void {
  const step = Number(`1e${exponent}`);
  const digits = Math.max(0, -exponent);
  slider.step = step.toFixed(digits);
  slider.min = (Math.floor(low / step) * step).toFixed(digits);
  slider.max = (Math.ceil(high / step) * step).toFixed(digits);
}

export const isAt = (slider: HTMLInputElement, end: "min" | "max"): boolean =>
  Math.abs(Number(slider.value) - Number(slider[end])) < Number(slider.step) / 2;

const degrees = (value: number | null, none: string) => (value === null ? none : `${value}°`);

/** Any range is one that follows from the camera's pixels, or from the sight of a pilot. */
function setRange(mission: Mission, value: number | null): void {
  if (value === null && (mission.pixel !== null || mission.hasPilot)) mission.maxRange = null;
  if (value !== null && value > 0) mission.maxRange = mission.range = Math.max(mission.grain, value);
}

export class Limits {
  private readonly limits: Record<string, Limit> = {
    range: {
      name: "Range", get: (m) => m.maxRange, set: setRange,
      text: (m) => (m.maxRange === null ? `any (${metres(this.app.volume?.info.range_m ?? m.range)})` : metres(m.maxRange)),
    },
    near: {
      name: "Nearest", open: "min", get: (m) => m.minRange || null, set: (m, value) => (m.minRange = Math.max(0, Math.min(value ?? 0, m.range * 0.9))),
    },
    low: this.end("Lowest altitude", "altitude", 0),
    high: this.end("Highest altitude", "altitude", 1),
    "low-agl": this.end("Lowest above ground", "agl", 0),
    "high-agl": this.end("Highest above ground", "agl", 1),
    slant: {
      name: "Slant to the target", open: "max", unit: "degrees", get: (m) => m.incidence, text: (m) => degrees(m.incidence, "any"),
      set: (m, value) => (m.incidence = value === null || value >= 90 ? null : Math.max(1, value)),
    },
    tilt: {
      name: "Tilt of the camera", open: "max", unit: "degrees", get: (m) => m.tilt, text: (m) => degrees(m.tilt, m.camera === null ? "no camera" : "a gimbal"),
      set: (m, value) => (m.tilt = value === null ? null : Math.max(-90, Math.min(90, value))),
    },
  };

  constructor(private readonly app: App) {
    for (const [id, limit] of Object.entries(this.limits)) {
      const slider = input(id);
      slider.oninput = () => {
        const value = limit.open && isAt(slider, limit.open) ? null : Number(slider.value);
        app.edit((mission) => limit.set(mission, value), false);
      };
      slider.onchange = () => app.keep();
      let before: number | null = null;
      slider.onpointerdown = () => (before = limit.get(app.mission));
      // A finger that scrolls the panel leaves what it touched as it was.
      slider.onpointercancel = () => app.edit((mission) => limit.set(mission, before), true);
      const field = input(`${id}-number`);
      field.setAttribute("aria-label", `${limit.name}, ${limit.unit ?? "metres"}`);
      field.onfocus = () => field.select();
      field.onchange = () => {
        const value = /^\s*(any\b.*)?$/.test(field.value) ? null : quantity(field.value, limit.unit === "degrees" ? "angle" : "length");
        if (typeof value === "string") showMessage(`${limit.name}: ${value}; or "any"`, true);
        else if (this.isPossible(limit, value)) app.edit((mission) => limit.set(mission, value), true);
        else showMessage(`${limit.name} ${field.value}: not possible, or not beside the other limits. It stays as it was`, true);
        field.value = this.textOf(limit);
      };
    }
    app.onChange(() => this.show());
  }

  /** Whether a number that was typed can be set as it is. */
  private isPossible(limit: Limit, value: number | null): boolean {
    const tried = structuredClone(this.app.mission);
    limit.set(tried, value);
    const made = limit.get(tried);
    return value === null || made === null || Math.abs(made - value) <= tried.grain;
  }

  /** One end of a band, which stops before the other one: no limit changes but the one that is moved. */
  private end(name: string, band: "altitude" | "agl", end: 0 | 1): Limit {
    const from = band === "altitude" ? "low" : "low-agl";
    return {
      name, open: end === 0 ? "min" : "max",
      get: (mission) => mission[band]?.[end] ?? null,
      set: (mission, value) => {
        const made: Band = [...(mission[band] ?? [null, null])];
        made[end] = value;
        const [low, high] = made;
        const step = Number(input(from).step);
        if (low !== null && high !== null && low >= high) made[end] = made[1 - end]! + (end === 0 ? -step : step);
        mission[band] = made.every((one) => one === null) ? null : made;
      },
    };
  }

  private textOf(limit: Limit): string {
    const { mission } = this.app;
    const value = limit.get(mission);
    return limit.text?.(mission) ?? (value === null ? "any" : metres(value));
  }

  /** Ends of the sliders, for the scene and what is set. */
  private fit(): void {
    const { scene, mission } = this.app;
    if (!scene) return;
    const size = Math.max(scene.max[0] - scene.min[0], scene.max[1] - scene.min[1]);
    const exponent = Math.floor(Math.log10(size / 60));
    const step = Number(`1e${exponent}`);
    // What is dragged must not move under the pointer.
    const ends = (id: string, low: number, high: number) => input(id).matches(":active") || setEnds(input(id), exponent, low, high);
    ends("range", 0, Math.max(size, mission.maxRange ?? mission.range, mission.opened.maxRange ?? 0));
    ends("near", 0, Math.max(size / 4, mission.minRange));
    // An end more, which means any: numbers may reach up to it.
    const bands = (ids: string[], low: number, high: number, band: Band | null, opened: Band | null) => {
      const heights = [low, high, ...(band ?? []), ...(opened ?? [])].filter((height) => height !== null);
      for (const id of ids) ends(id, Math.min(...heights) - step, Math.max(...heights) + step);
    };
    bands(["low", "high"], scene.min[2], scene.max[2] + size / 3, mission.altitude, mission.opened.altitude);
    bands(["low-agl", "high-agl"], 0, scene.max[2] - scene.min[2] + size / 3, mission.agl, mission.opened.agl);
    for (const row of document.querySelectorAll<HTMLElement>(".agl")) row.hidden = !scene.has_ground && !mission.hasGround;
  }

  private show(): void {
    this.fit();
    const { mission, canEdit } = this.app;
    for (const [id, limit] of Object.entries(this.limits)) {
      const [slider, field, text] = [input(id), input(`${id}-number`), this.textOf(limit)];
      if (!slider.matches(":active")) slider.value = String(limit.get(mission) ?? (limit.open ? slider[limit.open] : mission.range));
      slider.setAttribute("aria-valuetext", text);
      if (field !== document.activeElement) field.value = text;
    }
    for (const id of ["tilt", "tilt-number"]) input(id).disabled = !canEdit || mission.camera === null;
  }
}
