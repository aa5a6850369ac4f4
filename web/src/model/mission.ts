// A mission as the page edits it, and as the text of a mission file (docs/mission-file.md).
import { Document, isMap, isSeq, parseDocument, type Node, type YAMLMap, type YAMLSeq } from "yaml";
import type { Box, Point, VolumeInfo } from "../engine/messages";

/** A polygon, faces of an object of the scene, an area of its map, or what the file says and the page cannot edit (several polygons). */
export type Target =
  | { kind: "polygon"; vertices: Point[]; front?: Point }
  | { kind: "face"; object: string; part: "roof" | "facade"; nearest: Point }
  | { kind: "area"; osm: string }
  | { kind: "written" };

/** What the page has controls for. Lengths are metres in the scene's frame, angles degrees; null: no such limit. */
export interface Controls {
  target: Target | null;
  range: number;
  minRange: number;
  incidence: number | null;
  altitude: [number, number] | null;
  /** above the ground */
  agl: [number, number] | null;
  keepOut: Box[];
  /** a name of the engine's table, "written": numbers of the file */
  camera: string | null;
  /** pitch of a camera that does not turn up or down; null: a gimbal */
  tilt: number | null;
  pixel: number | null;
}

export interface Mission extends Controls {
  /** a file without its section `scene`; what the page has no controls for stays as it is there */
  written: string;
  /** the controls as that file has them: what differs was edited */
  opened: Controls;
  /** coordinates are written as multiples of this, metres */
  grain: number;
  /** the file says what the ground is */
  hasGround: boolean;
}

/** A mission without a target, for a scene of this size in metres. */
export function emptyMission(size: number): Mission {
  const step = 10 ** Math.floor(Math.log10(size / 100));
  const controls: Controls = {
    target: null, range: Math.max(step, Math.round(Math.min(300, size / 3) / step) * step), minRange: 0, incidence: null,
    altitude: null, agl: null, keepOut: [], camera: null, tilt: null, pixel: null,
  };
  const grain = 10 ** Math.floor(Math.log10(size) - 7);
  return { ...structuredClone(controls), written: "", opened: { ...controls, range: 0 }, grain, hasGround: false };
}

/** Sections `scene` as they were written, with their comments. */
const writtenScenes = new WeakMap<object, string>();

/** The text of a mission file in two: what it says of its scene, and the rest, on the lines where it was. */
export function divided(text: string): { scene: Record<string, unknown>; body: string } {
  const document = parseDocument(text);
  const [error] = document.errors;
  if (error) throw new Error(`this mission cannot be read: ${error.message}`);
  if (!isMap(document.contents)) throw new Error("this is not a mission file: it has no keys");
  const scene = (document.toJS() as { scene?: Record<string, unknown> }).scene ?? {};
  const pair = document.contents.items.find((item) => (item.key as { value?: unknown } | null)?.value === "scene");
  if (!pair) return { scene, body: text };
  if (document.contents.flow) {
    document.delete("scene");
    return { scene, body: String(document) };
  }
  const from = (pair.key as Node).range![0];
  const to = (pair.value as Node | null)?.range?.[2] ?? text.indexOf("\n", from);
  if (isMap(pair.value)) writtenScenes.set(scene, `${text.slice(from, to).trimEnd()}\n`);
  return { scene, body: text.slice(0, from) + text.slice(from, to).replace(/[^\n]/g, "") + text.slice(to) };
}

/** The section `scene` of a mission file. */
export const sceneText = (scene: Record<string, unknown>) => writtenScenes.get(scene) ?? String(new Document({ scene }));

/** A mission that was read, and what the engine says of it. */
export function missionFrom(written: string, info: VolumeInfo, grain: number): Mission {
  const document = parseDocument(written);
  const { limits } = info;
  const cameraName = document.getIn(["sensor", "camera", "model"]);
  const hasCamera = document.hasIn(["sensor", "camera"]) || document.hasIn(["sensor", "fov"]);
  const tilt = document.getIn(["sensor", "mount", "pitch"]);
  const pixel = document.getIn(["sensor", "pixel", "size"]);
  const isOnePolygon = info.target.length === 1 && info.target[0]!.length >= 3;
  const controls: Controls = {
    target: isOnePolygon ? { kind: "polygon", vertices: info.target[0]! } : { kind: "written" },
    range: limits.max_range ?? info.range_m,
    minRange: limits.min_range,
    incidence: limits.incidence,
    altitude: limits.altitude,
    agl: limits.agl,
    keepOut: limits.keep_out,
    camera: typeof cameraName === "string" ? cameraName : hasCamera ? "written" : null,
    tilt: typeof tilt === "number" ? tilt : null,
    pixel: typeof pixel === "number" ? pixel : null,
  };
  // A polygon of another kind (a roof, an area of the map) says by its normal where its front is, once it is moved.
  if (controls.target?.kind === "polygon" && !document.hasIn(["target", "vertices"])) controls.target.front = info.normal;
  const hasGround = document.hasIn(["navigation", "ground"]);
  return { ...structuredClone(controls), written, opened: controls, grain, hasGround };
}

/** A multiple of the grain, a power of ten, without the digits that are noise. */
export function rounded(value: number, grain: number): number {
  const digits = Math.max(0, Math.round(-Math.log10(grain)));
  return Number(value.toFixed(Math.min(20, digits)));
}

const TOLERANCE = 0.01; // metres, where a mission does not say

const differs = (a: unknown, b: unknown) => JSON.stringify(a) !== JSON.stringify(b);

/** Keys that say where a target is. */
const PLACES = [
  "vertices", "parts", "point", "outline", "holes", "osm", "object", "at", "part", "facing", "nearest", "center", "width",
  "length", "heading", "edges", "offset",
];

/** Writes the controls that were edited into the file that was opened. */
class Writer {
  readonly document: Document;

  constructor(private readonly mission: Mission) {
    this.document = parseDocument(mission.written || "{}") as unknown as Document;
    if (!isMap(this.document.contents)) this.document.contents = this.document.createNode({}) as never;
    (this.document.contents as unknown as YAMLMap).flow = false;
  }

  text(isDraft: boolean): string {
    const { mission, document } = this;
    const { opened } = mission;
    const isMoved = differs(mission.target, opened.target);
    const hasOtherBoxes = differs(mission.keepOut, opened.keepOut);
    if (isMoved || hasOtherBoxes) this.leaveOtherCoordinates();
    if (isMoved) this.setTarget(mission.target!);
    if (differs(mission.range, opened.range)) this.set(["sensor", "max_range"], this.number(mission.range));
    if (differs(mission.minRange, opened.minRange)) {
      this.set(["sensor", "min_range"], mission.minRange > 0 ? this.number(mission.minRange) : null);
    }
    if (differs(mission.incidence, opened.incidence)) this.set(["sensor", "incidence"], mission.incidence);
    this.setCamera();
    if (differs(mission.altitude, opened.altitude)) this.setHeights("z", mission.altitude);
    if (differs(mission.agl, opened.agl)) this.setHeights("agl", mission.agl);
    if (hasOtherBoxes) this.setBoxes(mission.keepOut);
    if (isDraft) this.coarsen();
    return document.toString({ lineWidth: 120, directives: false }); // the section `scene` is written before it
  }

  /** Round surfaces with a tenth of the facets: they take most of the time to compute and to draw. */
  private coarsen(): void {
    const { document } = this;
    if (document.get("method") === "spheres") return;
    const own = document.getIn(["exact", "tolerance"]);
    document.setIn(["exact", "tolerance"], 10 * (typeof own === "number" ? own : TOLERANCE));
  }

  private number(value: number): number {
    return rounded(value, this.mission.grain);
  }

  private point(values: readonly number[]): YAMLSeq {
    return this.document.createNode(values.map((v) => this.number(v)), { flow: true }) as unknown as YAMLSeq;
  }

  /** null: the key is left out, and what holds it, when that is empty. */
  private set(path: string[], value: unknown): void {
    const { document } = this;
    if (value !== null) return document.setIn(path, value);
    if (document.hasIn(path)) document.deleteIn(path);
    for (let above = path.slice(0, -1); above.length > 0; above = above.slice(0, -1)) {
      const holder = document.getIn(above);
      if (isMap(holder) && holder.items.length === 0) document.deleteIn(above);
    }
  }

  /** Coordinates of the page are those of the scene: a file in map coordinates must not mix the two. */
  private leaveOtherCoordinates(): void {
    const { document, mission } = this;
    if (!document.has("crs")) return;
    const zones = ["keep_in", "boxes", "keep_out"].flatMap((key) => {
      const list = document.getIn(["navigation", key]);
      return isSeq(list) ? list.items : [];
    });
    if (zones.some((zone) => isMap(zone) && !zone.has("file"))) {
      throw new Error(`this mission gives its zones in ${String(document.get("crs"))}: move its target in the file`);
    }
    document.delete("crs");
    const written = mission.opened.target;
    if (written && !differs(mission.target, written)) this.setTarget(written);
  }

  private setTarget(target: Target): void {
    const { document } = this;
    if (target.kind === "written") throw new Error("this mission has several polygons: draw a new target instead");
    const hadOne = document.has("target") && !document.has("targets");
    for (const key of ["targets", "combine"]) document.delete(key);
    if (!hadOne) document.set("target", document.createNode({ name: "target" }));
    for (const key of PLACES) document.deleteIn(["target", key]);
    if (target.kind === "area") {
      document.deleteIn(["target", "front"]);
      document.setIn(["target", "osm"], target.osm);
      return;
    }
    if (target.kind === "face") {
      document.deleteIn(["target", "front"]);
      document.setIn(["target", "object"], target.object);
      document.setIn(["target", "part"], target.part);
      document.setIn(["target", "nearest"], this.point(target.nearest));
      return;
    }
    const corners = document.createNode([]) as unknown as YAMLSeq;
    for (const corner of target.vertices) corners.add(this.point(corner));
    document.setIn(["target", "vertices"], corners);
    if (target.front) {
      const front = target.front.map((x) => Number(x.toPrecision(12)));
      document.setIn(["target", "front"], document.createNode(front, { flow: true }));
    }
  }

  private setCamera(): void {
    const { mission } = this;
    const { opened } = mission;
    if (differs(mission.camera, opened.camera) && mission.camera !== "written") {
      this.set(["sensor", "fov"], null);
      this.set(["sensor", "camera"], mission.camera === null ? null : this.document.createNode({ model: mission.camera }));
      if (mission.camera === null) for (const key of ["dori", "gimbal", "mount", "pixel"]) this.set(["sensor", key], null);
    }
    if (differs(mission.tilt, opened.tilt)) {
      this.set(["sensor", "gimbal"], null);
      const mount = mission.tilt === null ? null : { yaw: "any", pitch: mission.tilt };
      this.set(["sensor", "mount"], mount && this.document.createNode(mount, { flow: true }));
    }
    if (differs(mission.pixel, opened.pixel)) {
      this.set(["sensor", "dori"], null);
      const pixel = mission.pixel === null ? null : { size: mission.pixel };
      this.set(["sensor", "pixel"], pixel && this.document.createNode(pixel, { flow: true }));
    }
  }

  /** A list holds heights of the scene; those above the ground need a map, which may hold both. */
  private setHeights(key: "z" | "agl", heights: [number, number] | null): void {
    const { document } = this;
    const band = heights && this.point(heights);
    const path = ["navigation", "altitude"];
    const own = document.getIn(path, true);
    if (!isMap(own)) {
      if (key === "z") return this.set(path, band);
      if (!band) return;
      document.setIn(path, document.createNode(isSeq(own) ? { z: own } : {}, { flow: true }));
    }
    this.set([...path, key], band);
  }

  private setBoxes(boxes: Box[]): void {
    const { document } = this;
    const path = ["navigation", "keep_out"];
    const list = document.getIn(path);
    const others = isSeq(list) ? list.items.filter((item) => !(isMap(item) && item.has("min"))) : [];
    const zones = document.createNode([]) as unknown as YAMLSeq;
    for (const box of boxes) {
      const zone = document.createNode({}) as unknown as YAMLMap;
      zone.set("min", this.point(box.min));
      zone.set("max", this.point(box.max));
      zones.add(zone);
    }
    for (const other of others) zones.add(other);
    this.set(path, zones.items.length > 0 ? zones : null);
  }
}

/**
 * Without the section `scene`: the engine has the scene. `isDraft`: for a volume that is shown while something is dragged.
 * Throws where the page cannot write what was edited.
 */
export function missionText(mission: Mission, isDraft = false): string {
  if (!mission.target) throw new Error("there is no target");
  return new Writer(mission).text(isDraft);
}
