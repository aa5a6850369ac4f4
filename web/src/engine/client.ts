// The engine as the page sees it: promises, and volumes that follow what is dragged.
import type { About, Answer, EngineError, PointAnswer, Request, SceneInfo, Section, ViewMesh, VolumeInfo } from "./messages";

export class EngineFailure extends Error {
  constructor(readonly told: EngineError) {
    super(told.problem);
  }
}

/** What went wrong, and what to do, in words. */
export function toldBy(error: unknown): string {
  if (!(error instanceof EngineFailure)) return error instanceof Error ? error.message : String(error);
  const { problem, where, fix } = error.told;
  return `${problem}${where ? ` (${where})` : ""}${fix ? `: ${fix}` : ""}`;
}

export interface Volume {
  info: VolumeInfo;
  mesh: ViewMesh;
  engine_ms: number;
  /** from the wish to the answer, milliseconds */
  total_ms: number;
}

interface Waiting {
  resolve(answer: Answer): void;
  reject(error: Error): void;
}

interface Wish {
  text: string;
  asked: number;
  resolve(volume: Volume | null): void;
  reject(error: Error): void;
}

export class Engine {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, Waiting>();
  private next = 1;
  private isComputing = false;
  private wish: Wish | null = null;
  about: About = { version: "", cameras: [] };

  private constructor(script: string) {
    const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.worker = new Worker(url);
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => this.take(data);
    this.worker.onerror = (event) => this.fail(new Error(event.message || "the engine stopped"));
  }

  /** `wasm`: compressed by gzip, in base64. */
  static async start(script: string, wasm: string): Promise<Engine> {
    if (typeof WebAssembly !== "object") throw new Error("this browser has no WebAssembly, which the engine needs");
    const engine = new Engine(script);
    const packed = Uint8Array.from(atob(wasm), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const bytes = await new Response(stream).arrayBuffer();
    engine.about = (await engine.ask({ call: "start", wasm: bytes }, [bytes])).value as About;
    return engine;
  }

  /** `text`: the section `scene` of a mission, which names `file`; `files`: this file and those that missions name. */
  async open(text: string, files: Record<string, ArrayBuffer>, file: string): Promise<{ info: SceneInfo; mesh: ViewMesh }> {
    const answer = await this.ask({ call: "open", text, file, files });
    return { info: answer.value as SceneInfo, mesh: answer.mesh! };
  }

  /** The volume of a mission; null where a newer wish came before this one's turn: only the newest waits. */
  compute(text: string): Promise<Volume | null> {
    return new Promise((resolve, reject) => {
      this.wish?.resolve(null);
      this.wish = { text, asked: performance.now(), resolve, reject };
      void this.pump();
    });
  }

  private async pump(): Promise<void> {
    if (this.isComputing || !this.wish) return;
    const { text, asked, resolve, reject } = this.wish;
    this.wish = null;
    this.isComputing = true;
    try {
      const { value, mesh, engine_ms } = await this.ask({ call: "compute", text });
      resolve({ info: value as VolumeInfo, mesh: mesh!, engine_ms, total_ms: performance.now() - asked });
    } catch (error) {
      reject(error as Error);
    }
    this.isComputing = false;
    void this.pump();
  }

  async query(points: [number, number, number][]): Promise<PointAnswer[]> {
    return ((await this.ask({ call: "query", points })).value as { answers: PointAnswer[] }).answers;
  }

  async prove(): Promise<{ verdict: string }> {
    return (await this.ask({ call: "prove" })).value as { verdict: string };
  }

  async slice(z: number): Promise<Section> {
    return (await this.ask({ call: "slice", z })).value as Section;
  }

  async save(format: string): Promise<Uint8Array> {
    return (await this.ask({ call: "save", format })).bytes!;
  }

  private ask(request: Request, transfer: Transferable[] = []): Promise<Answer> {
    return new Promise((resolve, reject) => {
      const id = this.next++;
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, request }, transfer);
    });
  }

  private take(answer: Answer): void {
    const waiting = this.waiting.get(answer.id);
    this.waiting.delete(answer.id);
    if (answer.error) waiting?.reject(new EngineFailure(answer.error));
    else waiting?.resolve(answer);
  }

  private fail(error: Error): void {
    for (const waiting of this.waiting.values()) waiting.reject(error);
    this.waiting.clear();
  }
}
