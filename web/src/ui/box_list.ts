// The keep-out boxes, by their coordinates.
import type { App } from "../app";
import type { Box } from "../engine/messages";
import { rounded } from "../model/mission";
import { quantity } from "../model/quantity";
import { button, element, input, showMessage } from "./page";

export class BoxList {
  constructor(private readonly app: App) {
    button("add-box").onclick = () => this.add();
    app.onChange(() => this.show());
  }

  /** Between the target and the range, to the east. */
  private add(): void {
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

  private show(): void {
    const list = element("boxes");
    const { keepOut } = this.app.mission;
    if (list.childElementCount !== keepOut.length) list.replaceChildren(...keepOut.map((_, i) => this.row(i)));
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

  private row(i: number): HTMLElement {
    const item = document.createElement("li");
    for (const [end, name] of [["min", "from"], ["max", "to"]] as const) {
      item.append(name);
      ["x", "y", "z"].forEach((axis, a) => {
        const field = document.createElement("input");
        field.inputMode = "decimal";
        field.disabled = !this.app.canEdit;
        field.setAttribute("aria-label", `box ${i + 1}, ${name} ${axis}, metres`);
        field.onchange = () => {
          const value = quantity(field.value, "length");
          if (typeof value === "number") this.app.edit((mission) => moveEnd(mission.keepOut[i]!, end, a, value), true);
          else showMessage(`Box ${i + 1}, ${name} ${axis}: ${value}`, true);
          field.value = this.coordinate(6 * i + (end === "min" ? a : 3 + a));
        };
        item.append(field);
      });
    }
    const remove = document.createElement("button");
    remove.textContent = "Remove";
    remove.disabled = !this.app.canEdit;
    remove.onclick = () => this.app.edit((mission) => mission.keepOut.splice(i, 1), true);
    item.append(remove);
    return item;
  }
}

/** Ends that come to lie the wrong way round change places. */
function moveEnd({ min, max }: Box, end: "min" | "max", axis: number, value: number): void {
  const other = end === "min" ? max[axis]! : min[axis]!;
  [min[axis], max[axis]] = [Math.min(other, value), Math.max(other, value)];
}
