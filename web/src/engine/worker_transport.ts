// The engine in a worker. It is made from a text, since a page from the disk may load no other file.
import type { Answer, Request } from "./messages";
import { Pending, type Transport } from "./transport";

export class WorkerTransport implements Transport {
  private readonly worker: Worker;
  private readonly pending = new Pending();

  private constructor(script: string) {
    this.worker = new Worker(URL.createObjectURL(new Blob([script], { type: "text/javascript" })));
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => this.pending.take(data);
    this.worker.onerror = (event) => this.pending.fail(new Error(event.message || "the engine stopped"));
  }

  /** `wasm`: compressed by gzip, in base64. */
  static async start(script: string, wasm: string): Promise<WorkerTransport> {
    if (typeof WebAssembly !== "object") throw new Error("this browser has no WebAssembly, which the engine needs");
    const transport = new WorkerTransport(script);
    await transport.ask({ call: "start", wasm: await unzipped(wasm) });
    return transport;
  }

  ask(request: Request): Promise<Answer> {
    const { id, answer } = this.pending.add();
    this.worker.postMessage({ id, request }, request.call === "start" ? [request.wasm] : []);
    return answer;
  }
}

/** Of gzip in base64. */
export function unzipped(text: string): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
