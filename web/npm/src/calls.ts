// Calls of the engine by name: python/wasm/src/exports.cpp is the other side.
import { readWasm } from "#wasm";
import { VantageError } from "./errors.js";
import createVantage, { type EngineModule } from "./vantage.js";

/** Told of a stage and the part of it that is done, 0 to 1; false stops the work. */
export type Progress = (stage: string, fraction: number) => unknown;

/** Where an array lies in the engine's memory. */
export interface Place {
  at: number;
  count: number;
}

export class Calls {
  private broken = "";

  private constructor(private readonly module: EngineModule) {}

  static async make(wasm?: ArrayBuffer | Uint8Array): Promise<Calls> {
    return new Calls(await createVantage({ wasmBinary: wasm ?? (await readWasm()) }));
  }

  get files(): EngineModule["FS"] {
    return this.module.FS;
  }

  call<T>(name: string, given: Record<string, unknown>, progress?: Progress): T {
    if (this.broken) throw stopped(this.broken);
    let raised: { error: unknown } | undefined;
    this.module.onProgress = (stage, fraction) => {
      try {
        return progress !== undefined && progress(stage, fraction) === false ? -1 : 0;
      } catch (error) { // it must not fly through the engine
        raised = { error };
        return -1;
      }
    };
    const answer = this.answer<T>(JSON.stringify({ call: name, arguments: given }));
    if (raised) throw raised.error;
    if (answer.error) throw new VantageError(answer.error);
    return answer.value as T;
  }

  private answer<T>(request: string): { value?: T; error?: ConstructorParameters<typeof VantageError>[0] } {
    const at = this.put(new TextEncoder().encode(`${request}\0`));
    try {
      return JSON.parse(this.module.UTF8ToString(this.module._vantage_python_call(at) >>> 0));
    } catch (error) {
      this.broken = error instanceof Error ? error.message : String(error);
      throw stopped(this.broken);
    } finally {
      if (!this.broken) this.module._free(at);
    }
  }

  put(bytes: Uint8Array): number {
    const at = this.module._malloc(Math.max(bytes.length, 1)) >>> 0;
    if (at === 0) {
      throw new VantageError({ kind: "input", code: "out-of-memory", problem: "there is not enough memory for this", where: "",
                               fix: "use a smaller scene or range" });
    }
    this.module.HEAPU8.set(bytes, at);
    return at;
  }

  free(at: number): void {
    if (!this.broken) this.module._free(at);
  }

  /** Copies, so that they outlive the engine's. */
  doubles({ at, count }: Place): Float64Array {
    return new Float64Array(this.module.HEAPU8.slice(at, at + 8 * count).buffer);
  }

  indices({ at, count }: Place): Uint32Array {
    return new Uint32Array(this.module.HEAPU8.slice(at, at + 4 * count).buffer);
  }

  bytes({ at, count }: Place): Uint8Array {
    return this.module.HEAPU8.slice(at, at + count);
  }
}

function stopped(problem: string): VantageError {
  return new VantageError({ kind: "internal", code: "internal-defect", problem: `the engine has stopped: ${problem}`, where: "",
                            fix: "make a new engine; a smaller scene may fit" });
}
