// The engine in a worker. It is made from a text, since a page from the disk may load no other file.
import type { Answer, Request } from "./messages";
import { Pending, Stopped, type Transport } from "./transport";

export class WorkerTransport implements Transport {
  private worker!: Worker;
  private readonly pending = new Pending();
  /** the scene that is open, as it was asked for */
  private opened: Request | null = null;

  private constructor(private readonly script: string, private readonly wasm: ArrayBuffer) {}

  /** `wasm`: compressed by gzip, in base64. */
  static async start(script: string, wasm: string): Promise<WorkerTransport> {
    if (typeof WebAssembly !== "object") throw new Error("this browser has no WebAssembly, which the engine needs");
    const transport = new WorkerTransport(script, await unzipped(wasm));
    await transport.begin();
    return transport;
  }

  private begin(): Promise<Answer> {
    const url = URL.createObjectURL(new Blob([this.script], { type: "text/javascript" }));
    this.worker = new Worker(url);
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => this.pending.take(data);
    this.worker.onerror = (event) => this.pending.fail(new Error(event.message || "the engine stopped"));
    return this.ask({ call: "start", wasm: this.wasm }).finally(() => URL.revokeObjectURL(url));
  }

  async ask(request: Request): Promise<Answer> {
    const { id, answer } = this.pending.add();
    this.worker.postMessage({ id, request });
    const given = await answer;
    if (request.call === "open") this.opened = request;
    return given;
  }

  /** A worker that computes hears nothing: another one takes its place, which has no volume yet. */
  stop(): boolean {
    this.worker.terminate();
    this.pending.fail(new Stopped());
    const { opened } = this;
    this.begin().catch(() => {}); // whoever asks next is told
    if (opened) this.ask(opened).catch(() => {});
    return true;
  }
}

/** Of gzip in base64. */
export function unzipped(text: string): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
