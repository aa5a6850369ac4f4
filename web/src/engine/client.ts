// The engine as the page sees it: promises, and volumes that follow what is dragged.
import type { About, Hello, MapArea, MissionInfo, Point, PointAnswer, Proof, SceneInfo, Section, ServedFlight, TargetVolume, ViewMesh, VolumeInfo } from "./messages";
import { EngineFailure, type Transport } from "./transport";

/** What went wrong, and what to do, in words. `isOfFile`: of a mission that was opened, whose lines and columns count. */
export function errorText(error: unknown, isOfFile = false): string {
  if (!(error instanceof EngineFailure)) return error instanceof Error ? error.message : String(error);
  const { problem, fix } = error.told;
  const where = placeOf(error) ? "" : partsOf(error.told.where, isOfFile).join(", "); // places in the scene are shown
  return `${problem}${where ? ` (${where})` : ""}${fix ? `: ${fix}` : ""}`;
}

/** Without folders, and without the files that the page made: the mission, and scene.obj. */
function partsOf(where: string, isOfFile: boolean): string[] {
  return where
    .replace(/[^()]*?(?:\.ya?ml|standard input)(?::(\d+):(\d+))?/i, (_, line?: string, column?: string) =>
      isOfFile && line ? `line ${line}, column ${column}` : "")
    .replace(/(^|[\s(,])\/(?:[^(),]*\/)?/g, "$1")
    .split(/\s*[(),]\s*/)
    .filter((part) => part !== "" && !/^scene\.\w/.test(part));
}

/** Where in the scene it is, if the engine says so. */
export function placeOf(error: unknown): Point | null {
  const found = error instanceof EngineFailure && /\bat \(([-\d.e+]+), ([-\d.e+]+), ([-\d.e+]+)\)/.exec(error.told.where);
  return found ? [Number(found[1]), Number(found[2]), Number(found[3])] : null;
}

export interface Volume {
  info: VolumeInfo;
  mesh: ViewMesh;
  engine_ms: number;
  /** from the wish to the answer, milliseconds */
  total_ms: number;
}

export class Engine {
  private awaited = 0;
  about: About = { version: "", cameras: [], formats: [] };
  /** the last volume in this scene: what query, prove, slice and save speak of, as their answers come in the same order */
  last: Volume | null = null;

  /** Other pages of the program compute, and what was asked here waits for them. */
  waits = false;
  onWaits: () => void = () => {};

  constructor(private readonly transport: Transport) {
    transport.onWaits = (waits) => {
      this.waits = waits;
      this.onWaits();
    };
  }

  /** No volume is on its way. */
  get isIdle(): boolean {
    return this.awaited === 0;
  }

  async greet(): Promise<void> {
    this.about = (await this.transport.ask({ call: "about" })).value as About;
  }

  /** What the program was started with. */
  async hello(): Promise<{ hello: Hello; mesh: ViewMesh }> {
    const answer = await this.transport.ask({ call: "hello" });
    const hello = answer.value as Hello;
    this.about = hello.about;
    return { hello, mesh: answer.mesh! };
  }

  /** The volume that hello() told of. */
  async shown(info: VolumeInfo): Promise<Volume> {
    const { mesh, engine_ms } = await this.transport.ask({ call: "shown" });
    return (this.last = { info, mesh: mesh!, engine_ms, total_ms: 0 });
  }

  /** `text`: the section `scene` of a mission, which names `file`; `files`: this file and those that missions name. */
  async open(text: string, files: Record<string, ArrayBuffer>, file: string): Promise<{ info: SceneInfo; mesh: ViewMesh }> {
    const answer = await this.transport.ask({ call: "open", text, file, files });
    this.last = null;
    return { info: answer.value as SceneInfo, mesh: answer.mesh! };
  }

  /**
   * The volume of a mission; null where a newer one was asked for before this one's turn: the engine keeps only the newest
   * that waits. It is asked while it computes, so that it need not wait for the page. Answers come in the order of the
   * questions.
   */
  async compute(text: string): Promise<Volume | null> {
    const asked = performance.now();
    ++this.awaited;
    try {
      const { value, mesh, engine_ms, stale } = await this.transport.ask({ call: "compute", text });
      if (stale) return null;
      return (this.last = { info: value as VolumeInfo, mesh: mesh!, engine_ms, total_ms: performance.now() - asked });
    } finally {
      if (--this.awaited === 0) this.waits = false;
    }
  }

  /** What a mission says; throws where it cannot be read, but not where its target is refused. */
  async read(text: string): Promise<MissionInfo> {
    return (await this.transport.ask({ call: "read", text })).value as MissionInfo;
  }

  /** The smallest area of the map where this is; null: there is none. */
  async area(x: number, y: number): Promise<MapArea | null> {
    return ((await this.transport.ask({ call: "area", points: [[x, y, 0]] })).value as { area: MapArea | null }).area;
  }

  async query(points: [number, number, number][]): Promise<PointAnswer[]> {
    return ((await this.transport.ask({ call: "query", points })).value as { answers: PointAnswer[] }).answers;
  }

  /** The flight that the program was started with, by the mission of the last volume, or else the one that was opened. */
  async flight(): Promise<ServedFlight> {
    return (await this.transport.ask({ call: "flight" })).value as ServedFlight;
  }

  /** A volume for each target of that mission; `labels` of the mesh: which target. */
  async volumes(): Promise<{ volumes: TargetVolume[]; mesh: ViewMesh }> {
    const { value, mesh } = await this.transport.ask({ call: "volumes" });
    return { volumes: (value as { volumes: TargetVolume[] }).volumes, mesh: mesh! };
  }

  async prove(): Promise<Proof> {
    return (await this.transport.ask({ call: "prove" })).value as Proof;
  }

  async slice(z: number): Promise<Section> {
    return (await this.transport.ask({ call: "slice", z })).value as Section;
  }

  async save(format: string): Promise<Uint8Array> {
    return (await this.transport.ask({ call: "save", format })).bytes!;
  }

  /** Ends what is computed. */
  stop(): void {
    if (this.transport.stop()) this.last = null;
  }
}
