// How requests reach an engine: in a worker, in the program, or none, where the answers are in the page already.
import type { Answer, EngineError, Request } from "./messages";

export interface Transport {
  ask(request: Request): Promise<Answer>;
  /** Ends what is computed, whose answer is an error then. True: the engine has lost its last volume with that. */
  stop(): boolean;
  /** Told whether a volume waits until other pages of the program have computed. */
  onWaits?: (waits: boolean) => void;
}

/** What was asked and then stopped by the user. */
export class Stopped extends Error {
  constructor() {
    super("stopped before it was done");
  }
}

export class EngineFailure extends Error {
  constructor(readonly told: EngineError) {
    super(told.problem);
  }
}

/** Requests that are not answered yet, by their numbers. */
export class Pending {
  private readonly waiting = new Map<number, { resolve(answer: Answer): void; reject(error: Error): void }>();
  private next = 1;
  onWaits: (waits: boolean) => void = () => {};

  add(): { id: number; answer: Promise<Answer> } {
    const id = this.next++;
    return { id, answer: new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject })) };
  }

  take(answer: Answer): void {
    if (answer.waits !== undefined) return this.onWaits(answer.waits); // its answer comes later
    const one = this.waiting.get(answer.id);
    this.waiting.delete(answer.id);
    if (answer.error) one?.reject(answer.error.code === "cancelled" ? new Stopped() : new EngineFailure(answer.error));
    else one?.resolve(answer);
  }

  fail(error: Error): void {
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
  }
}

/** A message of the program: src/live/request.h. */
export function decoded(message: ArrayBuffer): Answer {
  const length = new DataView(message).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length))) as
    Omit<Answer, "mesh" | "bytes"> & { mesh?: [number, number, number]; bytes?: number };
  const { mesh, bytes, ...rest } = header;
  const answer: Answer = rest;
  const at = 4 + length;
  if (mesh) {
    const [positions, triangles, labels] = mesh;
    answer.mesh = {
      positions: new Float32Array(message, at, positions),
      triangles: new Uint32Array(message, at + 4 * positions, triangles),
      labels: new Uint32Array(message, at + 4 * (positions + triangles), labels),
    };
  }
  if (bytes !== undefined) answer.bytes = new Uint8Array(message, at, bytes);
  return answer;
}
