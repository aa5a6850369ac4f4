/**
 * Visibility volumes: every position from which the whole of a convex polygon can be seen, as a closed 3D mesh.
 * Lengths are metres, z is up. The engine works in the thread that calls it: pages call it in a worker.
 */
import { Calls, type Place, type Progress } from "./calls.js";
import { inputError, VantageError } from "./errors.js";

export { VantageError, type Progress };

/** Files that a mission names, by the names that it has for them. Texts are UTF-8. */
export type Files = Record<string, Uint8Array | string>;

export interface ComputeOptions {
  onProgress?: Progress;
}

/** One reason for part of a volume's boundary. */
export interface Cause {
  kind: "scene" | "range" | "target_plane" | "navigation" | "sensor";
  name: string;
  areaM2: number;
  /** index of the object in the scene, where it is one */
  object: number | null;
}

/** A row for each point. */
export interface Answers {
  /** 1: the whole target is visible, in range, and the point is within the limits */
  inside: Uint8Array;
  /** signed distance to the boundary along the line to the target's centre, positive inside, metres */
  marginM: Float64Array;
  /** names of objects that hide some of the target */
  blockedBy: string[][];
  /** limits that the point breaks */
  outsideOf: string[][];
}

export interface Proof {
  verdict: "proved" | "not proved" | "wrong";
  [key: string]: unknown;
}

interface Made {
  result: number;
  mission: number;
  volume: number;
}

interface VolumeFacts {
  vertices: Place;
  faces: Place;
  cause_of: Place;
  causes: [Cause["kind"], string, number, number | null, string, number][];
  outcome: string;
  reason: string;
  hint: string;
  notes: [string, string][];
}

/** The volume of one mission: copies in JavaScript, and an object of the engine until `release`. */
export class Volume {
  /** x, y, z of each vertex, metres, in the scene's frame */
  readonly vertices: Float64Array;
  /** three indices for each facet, counter-clockwise from outside */
  readonly faces: Uint32Array;
  /** of each facet the index of its cause */
  readonly causeOf: Uint32Array;
  readonly causes: Cause[];
  /** "computed", or why there is none: "out_of_range", "blocked_at_once", "outside_limits", "no_common_view" */
  readonly outcome: string;
  /** why it is empty, a sentence */
  readonly reason: string;
  /** what to try next, where it is empty */
  readonly hint: string;
  /** what to know before relying on it */
  readonly notes: { code: string; text: string }[];
  /** what `vantage compute` writes beside a volume: docs/command-line.md */
  readonly report: Record<string, unknown>;
  private query_ = 0;

  /** Volumes come from `Engine.compute`. */
  constructor(private readonly calls: Calls, private readonly made: Made) {
    const facts = calls.call<VolumeFacts>("volume_facts", { volume: made.volume });
    this.vertices = calls.doubles(facts.vertices);
    this.faces = calls.indices(facts.faces);
    this.causeOf = calls.indices(facts.cause_of);
    this.causes = facts.causes.map(([kind, name, areaM2, object]) => ({ kind, name, areaM2, object }));
    this.outcome = facts.outcome;
    this.reason = facts.reason;
    this.hint = facts.hint;
    this.notes = facts.notes.map(([code, text]) => ({ code, text }));
    this.report = JSON.parse(calls.call<string>("result_report", { result: made.result }));
  }

  /** The bytes that `vantage compute -o volume.FORMAT` writes. `format`: one of `Engine.formats()`. */
  save(format = "ply"): Uint8Array {
    if (!/^[a-z0-9]+$/.test(format)) throw inputError("unknown-choice", `'${format}' is not a format`, "format", "choose one of Engine.formats()");
    return inFolder(this.calls, (folder) => {
      const file = `${folder}/volume.${format}`;
      this.calls.call("save_result", { result: this.made.result, files: [file] });
      return this.calls.files.readFile(file);
    });
  }

  /** What points (x, y, z in turn) see of the target: exact, without the mesh. */
  query(points: ArrayLike<number>, { onProgress }: ComputeOptions = {}): Answers {
    if (points.length % 3 !== 0) throw inputError("array-sizes-differ", `points has ${points.length} numbers`, "points", "pass x, y and z of each point");
    const given = Float64Array.from(points);
    if (!given.every(Number.isFinite)) throw inputError("coordinate-not-finite", "a coordinate is not finite", "points", "pass finite numbers");
    this.query_ ||= this.calls.call<number>("query", { mission: this.made.mission }, onProgress);
    const at = this.calls.put(new Uint8Array(given.buffer));
    try {
      const told = this.calls.call<{ inside: Place; margin_m: Place; blocked_by: string[][]; outside_of: string[][] }>(
        "answers", { query: this.query_, points: { at, count: given.length } }, onProgress);
      return { inside: this.calls.bytes(told.inside), marginM: this.calls.doubles(told.margin_m), blockedBy: told.blocked_by,
               outsideOf: told.outside_of };
    } finally {
      this.calls.free(at);
    }
  }

  /** Proves or refutes the volume: what `vantage prove --json` prints. */
  prove({ onProgress }: ComputeOptions = {}): Proof {
    return JSON.parse(this.calls.call<string>("prove", { mission: this.made.mission, volume: this.made.volume, shrink: 1e-6, maximal: false }, onProgress));
  }

  /** Gives its memory in the engine back. The arrays stay; `save`, `query` and `prove` work no more. */
  release(): void {
    for (const kind of ["result", "mission", "volume"] as const) this.calls.call(`free_${kind}`, { object: this.made[kind] });
    if (this.query_) this.calls.call("free_query", { object: this.query_ });
  }
}

/** An instance of the engine, with a memory of its own of up to 4 GB. */
export class Engine {
  private constructor(private readonly calls: Calls) {}

  /** `wasm`: the bytes of vantage.wasm. Default: the file that comes with the package. */
  static async create({ wasm }: { wasm?: ArrayBuffer | Uint8Array } = {}): Promise<Engine> {
    return new Engine(await Calls.make(wasm));
  }

  /** The version of vantage. */
  version(): string {
    return this.calls.call("version", {});
  }

  /** What volumes can be saved as: "ply", "glb" and others. */
  formats(): string[] {
    // Those for maps place the scene on the earth, which needs PROJ: this build lacks it.
    return this.calls.call("output_formats", { scenes: true });
  }

  /**
   * The volume of a mission.
   * @param mission the text of a mission file: docs/mission-file.md
   * @param files what it names: the mesh of its scene, and others
   * @throws VantageError something is wrong with them; it says where
   */
  compute(mission: string, files: Files = {}, options: ComputeOptions = {}): Volume {
    const volumes = this.computeEach(mission, files, options);
    const [first, ...more] = volumes;
    if (first && more.length === 0) return first;
    for (const volume of volumes) volume.release();
    throw inputError("not-applicable", `the mission asks for ${volumes.length} volumes`, "combine", "call computeEach");
  }

  /** All volumes of a mission: with `combine: each` one for each target. */
  computeEach(mission: string, files: Files = {}, { onProgress }: ComputeOptions = {}): Volume[] {
    return inFolder(this.calls, (folder) => {
      for (const [name, content] of Object.entries(files)) write(this.calls, folder, name, content);
      write(this.calls, folder, MISSION, mission);
      const [read, scene] = this.calls.call<[number, number]>("read_mission", { file: `${folder}/${MISSION}` }, onProgress);
      try {
        return this.calls.call<Made[]>("run", { mission: read }, onProgress).map((made) => new Volume(this.calls, made));
      } finally {
        this.calls.call("free_mission", { object: read });
        this.calls.call("free_scene", { object: scene });
      }
    });
  }
}

let shared: Promise<Engine> | undefined;

/** As `Engine.compute`, with an engine that is made by the first call and kept. */
export async function compute(mission: string, files: Files = {}, options: ComputeOptions = {}): Promise<Volume> {
  shared ??= Engine.create();
  const engine = await shared.catch((error) => {
    shared = undefined;
    throw error;
  });
  try {
    return engine.compute(mission, files, options);
  } catch (error) {
    if (error instanceof VantageError && error.kind === "internal") shared = undefined; // it may have stopped
    throw error;
  }
}

const MISSION = "mission.yaml";
const FOLDER = "/job";

function write(calls: Calls, folder: string, name: string, content: Uint8Array | string): void {
  const parts = name.split("/");
  if (name === "" || name.includes("\0") || parts.some((part) => part === "" || part === "." || part === "..")) {
    throw inputError("value-syntax", `'${name}' is not a name for a file`, "files", "give names relative to the mission, without '..'");
  }
  if (parts.length > 1) calls.files.mkdirTree(`${folder}/${parts.slice(0, -1).join("/")}`);
  calls.files.writeFile(`${folder}/${name}`, typeof content === "string" ? new TextEncoder().encode(content) : content);
}

/** With a folder in the engine's memory, which goes again; errors do not name it. */
function inFolder<T>(calls: Calls, work: (folder: string) => T): T {
  calls.files.mkdirTree(FOLDER);
  try {
    return work(FOLDER);
  } catch (error) {
    if (!(error instanceof VantageError)) throw error;
    const { kind, code, problem, where, fix } = error;
    const told = (text: string) => text.replaceAll(`${FOLDER}/`, "");
    throw new VantageError({ kind, code, problem: told(problem), where: told(where), fix: told(fix) });
  } finally {
    remove(calls, FOLDER);
  }
}

function remove(calls: Calls, folder: string): void {
  for (const name of calls.files.readdir(folder)) {
    if (name === "." || name === "..") continue;
    const path = `${folder}/${name}`;
    if (calls.files.isDir(calls.files.stat(path).mode)) remove(calls, path);
    else calls.files.unlink(path);
  }
  calls.files.rmdir(folder);
}
