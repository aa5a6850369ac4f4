// A mission as the page edits it, and as the text of a mission file (docs/mission-file.md).
import { Document, isMap, isSeq, parseDocument, type Node, type YAMLMap, type YAMLSeq } from "yaml";
import type { Box, MissionInfo, Point, SceneInfo } from "../engine/messages";
import { farHeight, readBand, writeBand, type Band, type BandKey } from "./heights";
import { writtenQuantity, type QuantityKind } from "./quantity";

export interface PolygonTarget {
  kind: "polygon";
  vertices: Point[];
  front?: Point;
}

/** A polygon, faces of an object of the scene, an area of its map, or what the file says and the page cannot edit (several polygons). */
export type Target =
  | PolygonTarget
  | { kind: "face"; object: string; part: "roof" | "facade"; nearest: Point }
  | { kind: "area"; osm: string }
  | { kind: "written" };

/** What the page has controls for. Lengths are metres in the scene's frame, angles degrees; null: no such limit. */
export interface Controls {
  target: Target | null;
  /** null: it follows from what else the mission says */
  maxRange: number | null;
  minRange: number;
  incidence: number | null;
  altitude: Band | null;
  /** above the ground */
  agl: Band | null;
  keepOut: Box[];
  /** a name of the engine's table, "written": numbers of the file */
  camera: string | null;
  /** pitch of a camera that does not turn up or down; null: a gimbal */
  tilt: number | null;
  /** what one pixel may cover */
  pixel: number | null;
}

export interface Mission extends Controls {
  /** a file without its section `scene`; what the page has no controls for stays as it is there */
  written: string;
  /** the controls as that file has them: what differs was edited */
  opened: Controls;
  /** where the target of that file lies */
  parts: Point[][];
  /** how far positions are from the target at most, metres */
  range: number;
  /** coordinates are written as multiples of this, metres */
  grain: number;
  /** no height of the scene, of its ground or of the file's target is farther from 0, metres */
  top: number;
  /** the file says what the ground is */
  hasGround: boolean;
  /** the file limits the range by how far a pilot sees the aircraft */
  hasPilot: boolean;
}

/** The box of a scene. */
export type Extent = Pick<SceneInfo, "min" | "max">;

const sizeOf = ({ min, max }: Extent) => Math.max(max[0] - min[0], max[1] - min[1], 1e-9);
const grainOf = (scene: Extent) => 10 ** Math.floor(Math.log10(sizeOf(scene)) - 7);
const farthest = (heights: number[]) => Math.max(...heights.map(Math.abs));

/** A mission without a target. */
export function emptyMission(scene: Extent = { min: [0, 0, 0], max: [100, 100, 0] }): Mission {
  const size = sizeOf(scene);
  const step = 10 ** Math.floor(Math.log10(size / 100));
  const range = Math.max(step, Math.round(Math.min(300, size / 3) / step) * step);
  const controls: Controls = {
    target: null, maxRange: range, minRange: 0, incidence: null, altitude: null, agl: null, keepOut: [], camera: null, tilt: null,
    pixel: null,
  };
  return {
    ...structuredClone(controls), written: "", opened: { ...controls, maxRange: null }, parts: [], range, grain: grainOf(scene),
    top: farthest([scene.min[2], scene.max[2]]), hasGround: false, hasPilot: false,
  };
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

/** Pixels per metre of the levels of EN 62676-4. */
const DORI: Record<string, number> = { detection: 25, observation: 62, recognition: 125, identification: 250 };

const numberIn = (document: Document, path: string[], kind: QuantityKind = "length"): number | null =>
  writtenQuantity(document.getIn(path), kind);

/** A mission that was read, and what the engine says of it. Where that names no target (a volume to fly through) it has none. */
export function missionFrom(written: string, info: MissionInfo, scene: Extent): Mission {
  const document = parseDocument(written) as unknown as Document;
  const { limits } = info;
  const cameraName = document.getIn(["sensor", "camera", "model"]);
  const hasCamera = document.hasIn(["sensor", "camera"]) || document.hasIn(["sensor", "fov"]);
  const dori = DORI[String(document.getIn(["sensor", "dori"]))];
  const isOnePolygon = info.target.length === 1 && info.target[0]!.length >= 3;
  // Not that of the engine, which may be what follows from the camera.
  const maxRange = numberIn(document, ["sensor", "max_range"]);
  const ground = numberIn(document, ["navigation", "ground"]) ?? 0;
  const top = farthest([scene.min[2], scene.max[2], ground, ...info.target.flat().map(([, , z]) => z)]);
  const far = farHeight(top, maxRange);
  const controls: Controls = {
    target: isOnePolygon ? { kind: "polygon", vertices: info.target[0]! } : info.target.length > 0 ? { kind: "written" } : null,
    maxRange,
    minRange: limits.min_range,
    incidence: limits.incidence,
    altitude: readBand(document, "z", limits.altitude, far),
    agl: readBand(document, "agl", limits.agl, far),
    keepOut: limits.keep_out,
    camera: typeof cameraName === "string" ? cameraName : hasCamera ? "written" : null,
    tilt: numberIn(document, ["sensor", "mount", "pitch"], "angle"),
    pixel: dori ? 1 / dori : numberIn(document, ["sensor", "pixel", "size"]),
  };
  // What is drawn anew has not this front. A polygon of another kind (a roof, an area of the map) says by its normal where
  // its front is, once it is moved.
  const hasDefaultFront = document.hasIn(["target", "vertices"]) && !document.hasIn(["target", "front"]);
  if (controls.target?.kind === "polygon" && !hasDefaultFront) controls.target.front = info.normal;
  return {
    ...structuredClone(controls), written, opened: controls, parts: info.target, range: maxRange ?? info.range_m, grain: grainOf(scene), top,
    hasGround: document.hasIn(["navigation", "ground"]), hasPilot: document.hasIn(["sensor", "vlos"]),
  };
}

/** A multiple of the grain, a power of ten, without the digits that are noise. */
export function rounded(value: number, grain: number): number {
  const digits = Math.max(0, Math.round(-Math.log10(grain)));
  return Number(value.toFixed(Math.min(20, digits)));
}

const TOLERANCE = 0.01; // metres, where a mission does not say

const differs = (a: unknown, b: unknown) => JSON.stringify(a) !== JSON.stringify(b);

/** Keys of `navigation` that mean the same whatever `crs` says. */
const WITHOUT_COORDINATES = ["altitude", "ground", "clearance", "meshes"];

/** Keys that say where a target is. */
const PLACES = [
  "vertices", "parts", "point", "outline", "holes", "osm", "object", "at", "part", "facing", "nearest", "center", "width",
  "length", "heading", "edges", "offset", "file", "feature",
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
    if (differs(mission.maxRange, opened.maxRange)) this.setRange(mission.maxRange);
    if (differs(mission.minRange, opened.minRange)) {
      this.set(["sensor", "min_range"], mission.minRange > 0 ? this.number(mission.minRange) : null);
    }
    if (differs(mission.incidence, opened.incidence)) this.set(["sensor", "incidence"], mission.incidence);
    this.setCamera();
    if (differs(mission.tilt, opened.tilt)) this.setTilt(mission.tilt);
    if (differs(mission.pixel, opened.pixel)) this.setPixel(mission.pixel);
    this.setHeights("z", mission.altitude, opened.altitude);
    this.setHeights("agl", mission.agl, opened.agl);
    if (hasOtherBoxes) this.setBoxes(mission.keepOut);
    if (isDraft) this.coarsen();
    return document.toString({ lineWidth: 120, directives: false }); // the section `scene` is written before it
  }

  /** Round surfaces with a tenth of the facets: they take most of the time to compute and to draw. */
  private coarsen(): void {
    const { document } = this;
    if (document.get("method") === "spheres") return;
    document.setIn(["exact", "tolerance"], 10 * (numberIn(document, ["exact", "tolerance"]) ?? TOLERANCE));
  }

  private number(value: number): number {
    return rounded(value, this.mission.grain);
  }

  private point(values: readonly number[]): YAMLSeq {
    return this.document.createNode(values.map((v) => this.number(v)), { flow: true }) as unknown as YAMLSeq;
  }

  private setFlow(path: string[], value: Record<string, unknown>): void {
    this.document.setIn(path, this.document.createNode(value, { flow: true }));
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

  private zones(...keys: string[]): YAMLMap[] {
    return keys.flatMap((key) => {
      const list = this.document.getIn(["navigation", key]);
      return isSeq(list) ? list.items.filter((zone) => isMap(zone)) : [];
    });
  }

  /** What else has coordinates as `crs` says. A limit of navigation that is not known here counts as such. */
  private othersInCoordinates(): string | null {
    const { document } = this;
    const navigation = document.get("navigation");
    const keys = isMap(navigation) ? navigation.items.map((item) => String(item.key)) : [];
    const zones = ["keep_in", "boxes", "keep_out"];
    if (keys.some((key) => !zones.includes(key) && !WITHOUT_COORDINATES.includes(key))) return "limits";
    if (this.zones(...zones).some((zone) => !zone.has("file"))) return "zones";
    const home = document.getIn(["tour", "home"]);
    if (isSeq(home) && home.items.length === 3) return "home";
    const links = document.get("links");
    return isSeq(links) && links.items.some((link) => isMap(link) && link.has("point")) ? "links" : null;
  }

  /** Coordinates of the page are those of the scene: a file in map coordinates must not mix the two. */
  private leaveOtherCoordinates(): void {
    const { document, mission } = this;
    if (!document.has("crs")) return;
    const others = this.othersInCoordinates();
    if (others) {
      throw new Error(`this mission gives its ${others} in ${String(document.get("crs"))}: move its target in the file`);
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
    if (!target.front) document.deleteIn(["target", "front"]);
    else {
      const front = target.front.map((x) => Number(x.toPrecision(12)) + 0); // no -0
      document.setIn(["target", "front"], document.createNode(front, { flow: true }));
    }
  }

  /** A range takes the place of one that follows from how far a pilot sees the aircraft. */
  private setRange(maxRange: number | null): void {
    this.set(["sensor", "max_range"], maxRange && this.number(maxRange));
    if (maxRange !== null) this.set(["sensor", "vlos"], null);
  }

  private setCamera(): void {
    const { mission } = this;
    const { opened } = mission;
    if (differs(mission.camera, opened.camera) && mission.camera !== "written") {
      this.set(["sensor", "fov"], null);
      this.set(["sensor", "camera"], mission.camera === null ? null : this.document.createNode({ model: mission.camera }));
      if (mission.camera === null) for (const key of ["dori", "gimbal", "mount", "pixel"]) this.set(["sensor", key], null);
    }
  }

  /** A camera that does not tilt has a `mount`, one that does a `gimbal`: their yaw and roll are the same. */
  private setTilt(tilt: number | null): void {
    const { document } = this;
    const [from, to] = tilt === null ? ["mount", "gimbal"] : ["gimbal", "mount"];
    if (tilt !== null && isMap(document.getIn(["sensor", "mount"]))) return document.setIn(["sensor", "mount", "pitch"], tilt);
    const old = document.getIn(["sensor", from!]);
    const [yaw, roll] = isMap(old) ? [old.get("yaw"), old.get("roll")] : [];
    const others = roll === undefined ? {} : { roll };
    this.set(["sensor", from!], null);
    if (tilt !== null) this.setFlow(["sensor", to!], { yaw: yaw ?? "any", pitch: tilt, ...others });
    else if (roll !== undefined || (yaw !== undefined && yaw !== "any")) this.setFlow(["sensor", to!], { yaw: yaw ?? "any", ...others });
  }

  private setPixel(size: number | null): void {
    const { document } = this;
    const path = ["sensor", "pixel"];
    const hadDori = document.hasIn(["sensor", "dori"]);
    this.set(["sensor", "dori"], null);
    if (size === null) this.set(path, null);
    else if (isMap(document.getIn(path))) document.setIn([...path, "size"], size);
    else this.setFlow(path, { size, ...(hadDori && { kind: "perpendicular" }) }); // as dori is
  }

  /** Open ends are written anew with each text: they are farther than the range. */
  private setHeights(key: BandKey, heights: Band | null, opened: Band | null): void {
    const { document, mission } = this;
    if (!differs(heights, opened) && !heights?.includes(null)) return;
    const { target } = mission;
    const corners = target?.kind === "polygon" ? target.vertices.map(([, , z]) => z) : [];
    const rounded = heights && (heights.map((end) => end && this.number(end)) as Band);
    writeBand(document, key, rounded, farHeight(farthest([mission.top, ...corners]), mission.maxRange));
    if (heights) return;
    const path = ["navigation", "altitude"];
    const isMapOfBands = isMap(document.getIn(path));
    if (isMapOfBands || key === "z") this.set(isMapOfBands ? [...path, key] : path, null);
    if (key === "agl") this.leaveGround();
  }

  /** A mission may not say what the ground is where nothing is measured from it. */
  private leaveGround(): void {
    const { document } = this;
    const isMeasured = this.zones("keep_in", "boxes", "keep_out").some((zone) => zone.has("agl") || zone.has("file"));
    const isNamed = typeof document.getIn(["navigation", "ground"]) === "string";
    if (!isMeasured && !(isNamed && document.hasIn(["navigation", "clearance"]))) this.set(["navigation", "ground"], null);
  }

  private setBoxes(boxes: Box[]): void {
    const { document } = this;
    const path = ["navigation", "keep_out"];
    const list = document.getIn(path);
    const items = isSeq(list) ? list.items : [];
    const isBox = (item: unknown) => isMap(item) && item.has("min");
    const written = items.filter(isBox); // what was not edited stays as it was written
    const { keepOut } = this.mission.opened;
    const others = items.filter((item) => !isBox(item));
    const zones = document.createNode([]) as unknown as YAMLSeq;
    for (const box of boxes) {
      const old = written.length === keepOut.length ? keepOut.findIndex((one) => !differs(one, box)) : -1;
      if (old >= 0) {
        zones.add(written[old]);
        continue;
      }
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
