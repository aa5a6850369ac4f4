// A report: what the engine answered when it was written.
import type { Answer, Request } from "./messages";
import { decoded, EngineFailure, type Transport } from "./transport";
import { unzipped } from "./worker_transport";

export class RecordedTransport implements Transport {
  private constructor(private readonly answers: Map<string, Answer>) {}

  /** Messages of the program by their calls, each compressed by gzip, in base64. */
  static async start(messages: Record<string, string>): Promise<RecordedTransport> {
    const answers = new Map<string, Answer>();
    for (const [call, text] of Object.entries(messages)) {
      if (call !== "made") answers.set(call, decoded(await unzipped(text))); // the day, as it stands
    }
    return new RecordedTransport(answers);
  }

  ask(request: Request): Promise<Answer> {
    const answer = this.answers.get(request.call);
    if (answer?.error) return Promise.reject(new EngineFailure(answer.error));
    if (answer) return Promise.resolve(answer);
    if (request.call === "prove") return Promise.reject(new Error("No proof was asked for when this report was written"));
    return Promise.reject(new Error("this is a report: run `vantage view` with its mission to change anything"));
  }

  stop(): boolean {
    return false;
  }
}
