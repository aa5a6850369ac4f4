// Sliders, and beside each the number that it stands for, to be typed.
import type { App } from "../app";
import type { Mission } from "../model/mission";
import { input, metres, say } from "./page";

/** null: no limit. */
interface Limit {
  name: string;
  get(mission: Mission): number | null;
  set(mission: Mission, value: number | null): void;
  /** the end of the slider that means no limit */
  open?: "min" | "max";
  text?(mission: Mission): string;
}

const degrees = (value: number | null, none: string) => (value === null ? none : `${value}°`);

export class Limits {
  private readonly limits: Record<string, Limit> = {
    range: { name: "Range", get: (m) => m.range, set: (m, value) => value !== null && value > 0 && (m.range = Math.max(m.grain, value)) },
    near: {
      name: "Nearest", open: "min", get: (m) => m.minRange || null, set: (m, value) => (m.minRange = Math.max(0, Math.min(value ?? 0, m.range * 0.9))),
    },
    low: this.end("Lowest", "altitude", 0),
    high: this.end("Highest", "altitude", 1),
    "low-agl": this.end("Lowest above ground", "agl", 0),
    "high-agl": this.end("Highest above ground", "agl", 1),
    slant: {
      name: "Slant to the target", open: "max", get: (m) => m.incidence, text: (m) => degrees(m.incidence, "any"),
      set: (m, value) => (m.incidence = value === null || value >= 90 ? null : Math.max(1, value)),
    },
    tilt: {
      name: "Tilt of the camera", open: "max", get: (m) => m.tilt, text: (m) => degrees(m.tilt, m.camera === null ? "no camera" : "a gimbal"),
      set: (m, value) => (m.tilt = value === null ? null : Math.max(-90, Math.min(90, value))),
    },
  };

  constructor(private readonly app: App) {
    for (const [id, limit] of Object.entries(this.limits)) {
      const slider = input(id);
      slider.oninput = () => {
        const value = limit.open && slider.value === slider[limit.open] ? null : Number(slider.value);
        app.edit((mission) => limit.set(mission, value), false);
      };
      slider.onchange = () => app.keep();
      const field = input(`${id}-number`);
      field.setAttribute("aria-label", `${limit.name}, ${limit.text ? "degrees" : "metres"}`);
      field.onfocus = () => field.select();
      field.onchange = () => {
        const value = /^\s*(any)?\s*$/.test(field.value) ? null : Number.parseFloat(field.value.replace(",", "."));
        if (value === null || Number.isFinite(value)) app.edit((mission) => limit.set(mission, value), true);
        else say(`${limit.name}: write a number, or "any"`, true);
        field.value = this.textOf(limit);
      };
    }
    app.onChange(() => this.show());
  }

  /** One end of a band. The end that is moved pushes the other one before it. */
  private end(name: string, band: "altitude" | "agl", end: 0 | 1): Limit {
    const [from, to] = band === "altitude" ? ["low", "high"] : ["low-agl", "high-agl"];
    return {
      name, open: end === 0 ? "min" : "max",
      get: (mission) => mission[band]?.[end] ?? null,
      set: (mission, value) => {
        const [lowest, highest] = [Number(input(from!).min), Number(input(to!).max)];
        const [low, high] = mission[band] ?? [lowest, highest];
        const step = Number(input(from!).step);
        const made: [number, number] = end === 0 ? [value ?? lowest, high] : [low, value ?? highest];
        if (made[0] >= made[1]) made[1 - end] = made[end]! + (end === 0 ? step : -step);
        mission[band] = made[0] <= lowest && made[1] >= highest ? null : made;
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
    for (const row of document.querySelectorAll<HTMLElement>(".agl")) row.hidden = !scene.has_ground && !mission.hasGround;
  }

  private show(): void {
    this.fit();
    const { mission, canEdit } = this.app;
    for (const [id, limit] of Object.entries(this.limits)) {
      const [slider, field, text] = [input(id), input(`${id}-number`), this.textOf(limit)];
      if (!slider.matches(":active")) slider.value = String(limit.get(mission) ?? (limit.open ? slider[limit.open] : 0));
      slider.setAttribute("aria-valuetext", text);
      if (field !== document.activeElement) field.value = text;
    }
    for (const id of ["tilt", "tilt-number"]) input(id).disabled = !canEdit || mission.camera === null;
  }
}
