// The engine in a worker. It is made from a text, since a page from the disk may load no other file.
import type { Answer, Request } from "./messages";
import { Pending, Stopped, type Transport } from "./transport";

export class WorkerTransport implements Transport {
  private worker!: Worker;
  private readonly pending = new Pending();
  private started!: Promise<unknown>;
  /** the scene that is open, as it was asked for */
  private opened: Request | null = null;
  /** the worker has not opened it yet */
  private isToOpen = false;
  private opening: Promise<unknown> | null = null;

  private constructor(private readonly script: string, private readonly wasm: ArrayBuffer) {}

  /** `wasm`: compressed by gzip, in base64. */
  static async start(script: string, wasm: string): Promise<WorkerTransport> {
    if (typeof WebAssembly !== "object") throw new Error("this browser has no WebAssembly, which the engine needs");
    const transport = new WorkerTransport(script, await unzipped(wasm));
    transport.begin();
    await transport.started;
    return transport;
  }

  private begin(): void {
    const url = URL.createObjectURL(new Blob([this.script], { type: "text/javascript" }));
    this.worker = new Worker(url);
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => this.pending.take(data);
    this.worker.onerror = (event) => this.pending.fail(new Error(event.message || "the engine stopped"));
    this.started = this.post({ call: "start", wasm: this.wasm }).finally(() => URL.revokeObjectURL(url));
    this.started.catch(() => {}); // whoever asks is told
  }

  private post(request: Request): Promise<Answer> {
    const { id, answer } = this.pending.add();
    this.worker.postMessage({ id, request });
    return answer;
  }

  async ask(request: Request): Promise<Answer> {
    await this.started;
    await this.openAgain(request);
    const answer = await this.post(request);
    if (request.call === "open") {
      this.opened = request;
      this.isToOpen = false;
    }
    return answer;
  }

  /** After a stop, for what comes first and needs the scene. */
  private async openAgain({ call }: Request): Promise<void> {
    const isNeeded = this.isToOpen && this.opened && call !== "open" && call !== "about";
    if (isNeeded && !this.opening) {
      this.opening = this.post(this.opened!).then(() => (this.isToOpen = false)).finally(() => (this.opening = null));
    }
    // What is asked meanwhile keeps its order; only what needs the scene is told that it could not be opened.
    if (this.opening) await (call === "open" ? this.opening.catch(() => {}) : this.opening);
  }

  /** A worker that computes hears nothing: another one takes its place, which has no scene and no volume yet. */
  stop(): boolean {
    this.worker.onmessage = this.worker.onerror = null;
    this.worker.terminate();
    this.pending.fail(new Stopped());
    this.isToOpen = true;
    this.begin();
    return true;
  }
}

/** Of gzip in base64. */
export function unzipped(text: string): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
