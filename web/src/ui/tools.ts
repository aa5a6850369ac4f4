// What the pointer does: look, draw, pick, probe, and drag what is there.
import type { App } from "../app";
import { errorText } from "../engine/client";
import type { Point } from "../engine/messages";
import type { Mission, Target } from "../model/mission";
import { facing, faultOf, plus, times, type Plane } from "../model/polygon";
import { causeText } from "../model/volume";
import type { Hit } from "../view/city";
import type { Pointer } from "../view/stage";
import { dragOfBox, dragOfTarget, onPlane, type Drag } from "./drags";
import { button, element, showMessage } from "./page";

export type Tool = "look" | "draw" | "pick" | "probe";

const HINTS: Record<Tool, string> = {
  look: "",
  draw: "Click the corners of the target on the ground, a roof or a wall; Enter, or a double click, ends it",
  pick: "Click a roof, a wall or a square: all of it becomes the target",
  probe: "Click a place: what does a position above it see? Page Up and Page Down change its height",
};
const CLICK_PIXELS = 5;
const LOWEST = 0.02; // of the scene's height

/** A mission's target looks up where it says nothing; walls may lean. */
function polygonOn({ normal }: Plane, corners: Point[]): Target {
  return { kind: "polygon", vertices: facing(corners, normal), ...(normal[2] < 0.05 ? { front: normal } : {}) };
}

const isClick = (from: Pointer, to: Pointer) => Math.hypot(to.clientX - from.clientX, to.clientY - from.clientY) <= CLICK_PIXELS;

export class Tools {
  private tool: Tool = "look";
  /** what the corners that are drawn lie in */
  private plane: Plane | null = null;
  /** what is dragged, how that began, and in which mission */
  private drag: { follow: Drag; start: PointerEvent; mission: Mission; hasMoved: boolean } | null = null;
  private pressed: PointerEvent | null = null;
  /** the view is given an event that was kept from it */
  private isHanding = false;

  constructor(private readonly app: App) {
    const { canvas } = app.stage;
    canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    for (const end of ["pointercancel", "lostpointercapture"] as const) canvas.addEventListener(end, (event) => this.endDrag(event));
    canvas.addEventListener("pointerleave", () => (element("tip").hidden = true));
    canvas.addEventListener("dblclick", (event) => this.doubleClick(event));
    for (const tool of Object.keys(HINTS) as Tool[]) button(`tool-${tool}`).onclick = () => this.choose(tool);
    button("undo").onclick = () => this.undo();
    button("redo").onclick = () => this.redo();
    button("remove-corner").onclick = () => this.removeLast();
    button("probe-up").onclick = () => app.moveProbe([0, 0, 1]);
    button("probe-down").onclick = () => app.moveProbe([0, 0, -1]);
    button("remove-probe").onclick = () => app.setProbe(null);
    button("stop").onclick = () => app.stop();
    button("compute").onclick = () => void app.compute();
    app.onChange(() => this.showButtons());
  }

  choose(tool: Tool): void {
    if (this.app.isEye()) this.app.endEye();
    this.tool = tool;
    this.app.drawn = [];
    for (const name of Object.keys(HINTS)) button(`tool-${name}`).setAttribute("aria-pressed", String(name === tool));
    this.app.stage.canvas.style.cursor = tool === "look" ? "" : "crosshair";
    this.app.showMission();
    this.app.changed();
    showMessage(HINTS[tool]);
  }

  /** What a keyboard does with Esc, Del, Page Up and Page Down, for fingers, where it does something. */
  private showButtons(): void {
    const { probe, dragged, drawn, canEdit } = this.app;
    const corners = this.app.polygon()?.vertices.length ?? 0;
    button("remove-corner").hidden = !canEdit || (drawn.length === 0 && (dragged === null || corners <= 3));
    for (const id of ["probe-up", "probe-down", "remove-probe"]) button(id).hidden = !probe;
    button("stop").hidden = !this.app.isLate();
    button("compute").hidden = !this.app.wasStopped || this.app.isLate();
  }

  /** While a target is drawn: takes its last corner back. */
  undo(): void {
    if (this.app.drawn.length > 0) this.removeLast();
    else this.app.step(this.app.history.undo());
  }

  redo(): void {
    if (this.app.drawn.length === 0) this.app.step(this.app.history.redo());
  }

  /** Enter. */
  finish(): void {
    const { drawn } = this.app;
    if (drawn.length === 0 || !this.plane) return;
    const fault = faultOf(drawn);
    if (fault) return showMessage(fault.reason, true);
    this.take(polygonOn(this.plane, drawn));
  }

  /** Delete: the last corner that was drawn, or dragged. */
  removeLast(): void {
    if (this.tool === "draw") {
      this.app.drawn.pop();
      return this.showDrawn();
    }
    const { app } = this;
    const target = app.polygon();
    const { dragged } = app;
    if (!target || dragged === null) return showMessage("First drag the corner that is to go", true);
    if (target.vertices.length <= 3) return showMessage("A target has three corners or more", true);
    app.dragged = null;
    app.edit((mission) => (mission.target = { ...target, vertices: target.vertices.filter((_, i) => i !== dragged) }), true);
  }

  /** More fingers than one turn and zoom the view, and leave what the first drags to it, once it has moved. */
  private press(event: PointerEvent): void {
    if (this.isHanding) return;
    element("tip").hidden = true;
    const isFirst = event.isPrimary || event.pointerType !== "touch";
    this.pressed = isFirst ? event : null;
    const { app } = this;
    if (this.drag && !isFirst && !this.drag.hasMoved) return this.handToView(this.drag.start);
    if (this.drag || !isFirst || event.button !== 0 || this.tool === "draw" || this.tool === "pick" || !app.canEdit) return;
    const follow = dragOfTarget(app, event, this.tool === "look" && !app.isEye()) ?? dragOfBox(app, event);
    if (!follow) return;
    this.drag = { follow, start: event, mission: app.mission, hasMoved: false };
    app.stage.controls.enabled = false;
    app.stage.canvas.setPointerCapture(event.pointerId);
  }

  /** A second finger came before the first moved anything: both are the view's. */
  private handToView(start: PointerEvent): void {
    this.letGo();
    this.isHanding = true;
    this.app.stage.canvas.dispatchEvent(new PointerEvent(start.type, start));
    this.isHanding = false;
  }

  private move(event: PointerEvent): void {
    const { drag } = this;
    if (drag?.mission === this.app.mission) {
      if (drag.start.pointerId !== event.pointerId) return;
      // A finger of two that zoom trembles before the other one is there.
      drag.hasMoved ||= event.pointerType !== "touch" || !isClick(drag.start, event);
      return drag.hasMoved ? drag.follow(event) : undefined;
    }
    if (drag) this.letGo(); // it is of a mission that was replaced
    if (event.buttons !== 0) return;
    const { app } = this;
    const tip = element("tip");
    const cause = this.tool === "look" ? app.volumeView.causeAt(app.stage.ray(event)) : null;
    tip.hidden = !cause;
    if (!cause) return;
    tip.textContent = causeText(cause);
    const { x, y } = app.stage.onScreen(event);
    tip.style.left = `${x + 14}px`;
    tip.style.top = `${y + 10}px`;
  }

  private release(event: PointerEvent): void {
    const { pressed } = this;
    this.pressed = null;
    if (this.drag) this.endDrag(event);
    else if (pressed && isClick(pressed, event) && event.button === 0) this.click(event);
  }

  private endDrag({ pointerId }: PointerEvent): void {
    if (this.drag?.start.pointerId !== pointerId) return;
    this.letGo();
    this.app.keep();
  }

  private letGo(): void {
    this.drag = null;
    this.app.stage.controls.enabled = true;
    this.app.changed();
  }

  private click(event: PointerEvent): void {
    if (this.tool === "look") return;
    if (this.tool === "draw" && this.plane && this.app.drawn.length > 0) return this.drawCorner(event, this.plane);
    const hit = this.app.city.hit(this.app.stage.ray(event));
    if (!hit) return showMessage("There is no surface here: click the ground, a roof or a wall", true);
    if (this.tool === "draw") {
      this.plane = hit.plane;
      this.app.drawn = [hit.point];
      this.showDrawn();
    } else if (this.tool === "pick") {
      this.pick(hit);
    } else {
      this.probe(hit.point);
    }
  }

  /** On a side of the target: a new corner. */
  private doubleClick(event: MouseEvent): void {
    const { app } = this;
    if (this.tool === "draw") return this.finish();
    const target = app.polygon();
    if (!app.canEdit || this.tool !== "look" || !target || app.target.cornerAt(event, app.stage) >= 0) return;
    const side = app.target.sideAt(event, app.stage);
    if (side < 0) return;
    const to = target.vertices[(side + 1) % target.vertices.length]!;
    const middle = times(plus(target.vertices[side]!, to), 0.5);
    app.dragged = side + 1;
    const vertices = [...target.vertices.slice(0, side + 1), middle, ...target.vertices.slice(side + 1)];
    app.edit((mission) => (mission.target = { ...target, vertices }), true);
  }

  private drawCorner(event: PointerEvent, plane: Plane): void {
    const corner = this.app.target.cornerAt(event, this.app.stage);
    if (corner === 0 && this.app.drawn.length >= 3) return this.finish();
    if (corner >= 0) return; // the second click of a double one
    const at = onPlane(this.app, event, plane);
    if (!at) return;
    this.app.drawn.push(at);
    this.showDrawn();
  }

  private showDrawn(): void {
    const { app } = this;
    const fault = app.drawn.length >= 3 ? faultOf(app.drawn) : null;
    app.showMission();
    app.changed();
    if (fault) showMessage(`${fault.reason}, or press Del`, true);
    else showMessage(app.drawn.length >= 3 ? "Enter, a double click, or a click on the first corner ends it" : HINTS.draw);
  }

  private pick(hit: Hit): void {
    if (this.isOnGround(hit)) return void this.pickPlace(hit);
    const part = Math.abs(hit.plane.normal[2]) > 0.35 ? "roof" : "facade";
    this.take({ kind: "face", object: hit.object, part, nearest: hit.point });
    showMessage("All of this surface is the target now");
  }

  /** A mesh of one object does not say which of it is the ground: what lies lowest is. */
  private isOnGround({ object, kind, point, plane }: Hit): boolean {
    const { scene } = this.app;
    if (!scene || object === "" || kind === "ground") return true;
    const height = (point[2] - scene.min[2]) / (scene.max[2] - scene.min[2] || 1);
    return scene.objects.length === 1 && plane.normal[2] > 0.9 && height < LOWEST;
  }

  /** An area of the map; where there is none, the flat place as the mesh has it. */
  private async pickPlace(hit: Hit): Promise<void> {
    const { app } = this;
    const { scene } = app;
    if (scene?.has_areas) {
      showMessage("Looking for the area of the map…");
      try {
        const area = await app.late(app.engine.area(hit.point[0], hit.point[1]));
        if (scene !== app.scene || this.tool !== "pick") return;
        if (area) {
          this.take({ kind: "area", osm: area.osm });
          return showMessage(area.name === "" ? `This is ${area.osm}` : `This is ${area.name}`);
        }
      } catch (error) {
        return showMessage(errorText(error), true);
      }
    }
    const corners = app.city.flatPlace(hit, app.mission.range / 3);
    if (corners.length < 3) return showMessage("There is no room for a polygon here: draw a target", true);
    this.take(polygonOn(hit.plane, corners));
    showMessage("The flat place around this, as far as nothing stands there. Drag its corners to change it");
  }

  private take(target: Target): void {
    this.choose("look");
    this.app.dragged = null;
    this.app.edit((mission) => (mission.target = target), true);
  }

  /** A little above the place. */
  private probe([x, y, z]: Point): void {
    const { app } = this;
    app.setProbe([x, y, z + Math.min(20, app.mission.range / 5)]);
  }
}
