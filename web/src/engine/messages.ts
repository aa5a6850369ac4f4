// What the page and the worker, in which the engine runs, say to each other.

export type Point = [number, number, number];

export interface EngineError {
  code: string;
  problem: string;
  where: string;
  fix: string;
}

/** Of the engine. */
export interface About {
  version: string;
  cameras: { name: string; maker: string; model: string; fov_deg: [number, number] }[];
  /** that volumes are saved in: ends of names */
  formats: string[];
}

/** Something that the scene's source says stands there, and that is not built as it stands. */
export interface LedgerEntry {
  name: string;
  what: string;
  /** why it is not built */
  reason: string;
  /** what holds its place; "": nothing does */
  instead: string;
  held: boolean;
  may_be_larger: boolean;
  /** where it is; empty: nobody knows */
  rings: [number, number][][];
  low: number;
  high: number;
}

/** `worst`: what nothing holds the place of first; 500 at most. */
export interface Ledger {
  count: number;
  held: number;
  worst: LedgerEntry[];
}

export interface SceneInfo {
  hash: string;
  triangles: number;
  origin: Point;
  min: Point;
  max: Point;
  objects: { name: string; kind: string }[];
  /** something of it is known to be the ground, which heights can count from */
  has_ground: boolean;
  /** it is made of a map, which has areas: squares, pitches */
  has_areas: boolean;
  /** where on the earth its origin lies; null: nobody knows */
  place: { latitude_deg: number; longitude_deg: number; vertical: string } | null;
  /** whom pictures of it have to name; "": nobody is known */
  attribution: string;
  notes: string[];
  ledger: Ledger;
  read_ms: number;
  prepare_ms: number;
}

export interface Box {
  min: Point;
  max: Point;
}

/** A zone to stay in or out of, from one height to another; `rings`: its outline, then its holes. */
export interface Zone {
  kept_out: boolean;
  name: string;
  rings: [number, number][][];
  low: number;
  high: number;
}

/** The keys of a mission that the page has controls for, as the engine read them, and all limits in words. */
export interface Limits {
  /** null: the mission gives none */
  max_range: number | null;
  min_range: number;
  incidence: number | null;
  altitude: [number, number] | null;
  /** above the ground */
  agl: [number, number] | null;
  keep_out: Box[];
  all: { name: string; text: string }[];
  /** all but the boxes to stay out of */
  zones: Zone[];
}

export type CauseKind = "scene" | "range" | "target_plane" | "navigation" | "sensor" | "unknown";

/** What a mission says, whether it has a volume or not. */
export interface MissionInfo {
  /** of the target */
  name: string;
  target: Point[][];
  normal: Point;
  /** as far as a volume may reach, whatever limits it */
  range_m: number;
  limits: Limits;
}

export interface VolumeInfo extends MissionInfo {
  outcome: string;
  reason: string;
  hint: string;
  center: Point;
  /** what the volume claims of each position. `visible`: the least share of the target that it sees; 1: all of it */
  claim?: { visible: number; combine: "all" | "any" };
  volume_m3: number;
  area_m2: number;
  facets: number;
  causes: { kind: CauseKind; name: string }[];
  notes: { code: string; text: string }[];
  resolve_ms: number;
  compute_ms: number;
  view_ms: number;
}

/** A flight that the program judged; `check`: what `vantage check -o check.json` writes; `home`: on the ground. */
export interface ServedFlight {
  name: string;
  home: Point | null;
  notes: string[];
  check: unknown;
}

/** Of a target of a flight; `reason`: why it has no volume; "": it has one. */
export interface TargetVolume {
  name: string;
  reason: string;
}

/** What the program was started with. `mission`: text of the file `name`; `volume`: one that was given to be shown. */
export interface Hello {
  about: About;
  scene: SceneInfo;
  mission: string;
  name: string;
  volume: VolumeInfo | null;
  /** judged by that mission */
  flight: ServedFlight | null;
}

/** Triangles for drawing, about the scene's origin; `labels`: of each triangle its object, or its cause. */
export interface ViewMesh {
  positions: Float32Array;
  triangles: Uint32Array;
  labels: Uint32Array;
}

export interface PointAnswer {
  inside: boolean;
  margin_m: number | null;
  blocked_by: string[];
  out_of_range: boolean;
  behind_target: boolean;
  outside_of: string[];
}

/** A closed way or a multipolygon of the scene's map. */
export interface MapArea {
  /** way/123 */
  osm: string;
  name: string;
}

export interface Section {
  z_m: number;
  area_m2: number;
  polygons: [number, number][][][];
}

/** What `vantage prove --json` prints, as far as it is shown. */
export interface Proof {
  /** "proved", "wrong", "not proved" */
  verdict: string;
  claims: { name: string; verdict: string; text: string }[];
}

export type Request =
  | { call: "start"; wasm: ArrayBuffer }
  | { call: "about" }
  | { call: "hello" }
  | { call: "shown" }
  | { call: "open"; text: string; file: string; files: Record<string, ArrayBuffer> }
  | { call: "compute"; text: string }
  | { call: "read"; text: string }
  | { call: "query"; points: Point[] }
  | { call: "area"; points: [Point] }
  | { call: "flight" }
  | { call: "volumes" }
  | { call: "prove" }
  | { call: "slice"; z: number }
  | { call: "save"; format: string }
  | { call: "stop" };

export interface Envelope {
  id: number;
  request: Request;
}

export interface Answer {
  id: number;
  value?: unknown;
  error?: EngineError;
  mesh?: ViewMesh;
  bytes?: Uint8Array;
  /** a newer request took its place */
  stale?: boolean;
  /** no answer yet: whether it waits until other pages have computed */
  waits?: boolean;
  engine_ms: number;
}
