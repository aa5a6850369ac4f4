// The engine of the program that serves this page.
import type { Answer, Request } from "./messages";
import { decoded, Pending, type Transport } from "./transport";

const ENDED = "the connection to the program is lost: reload this page, or start the program again; saving the mission still works";

export class SocketTransport implements Transport {
  private readonly pending = new Pending();
  onWaits?: (waits: boolean) => void;

  private constructor(private readonly socket: WebSocket) {
    socket.binaryType = "arraybuffer";
    this.pending.onWaits = (waits) => this.onWaits?.(waits);
    socket.onmessage = ({ data }: MessageEvent<ArrayBuffer>) => this.pending.take(decoded(data));
  }

  /** `path` on the server of this page. */
  static start(path: string, onEnd: (reason: string) => void): Promise<SocketTransport> {
    return new Promise((resolve, reject) => {
      const socket = new WebSocket(`ws://${location.host}${path}`);
      const transport = new SocketTransport(socket);
      socket.onopen = () => resolve(transport);
      socket.onclose = () => {
        reject(new Error(ENDED));
        transport.pending.fail(new Error(ENDED));
        onEnd(ENDED);
      };
    });
  }

  ask(request: Request): Promise<Answer> {
    const { id, answer } = this.pending.add();
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ id, request }));
    else this.pending.fail(new Error(ENDED));
    return answer;
  }

  stop(): boolean {
    this.ask({ call: "stop" }).catch(() => {}); // who asked what is stopped is told
    return false;
  }
}
