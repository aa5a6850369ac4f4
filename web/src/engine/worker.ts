// Runs in a worker, after Emscripten's script: the engine, one call at a time.
import type { Answer, EngineError, Envelope, Request, ViewMesh } from "./messages";

interface Files {
  writeFile(name: string, bytes: Uint8Array): void;
  unlink(name: string): void;
  analyzePath(name: string): { exists: boolean };
}

interface Module {
  FS: Files;
  HEAPU8: Uint8Array;
  HEAPF32: Float32Array;
  HEAPU32: Uint32Array;
  HEAPF64: Float64Array;
  ccall(name: string, returns: string, types: string[], values: unknown[]): unknown;
  _malloc(size: number): number;
  _free(at: number): void;
}

declare const createVantage: (options: { wasmBinary: ArrayBuffer }) => Promise<Module>;
declare function postMessage(message: Answer, transfer: Transferable[]): void;
declare let onmessage: (event: MessageEvent<Envelope>) => void;

let engine: Module;

class Failed extends Error {
  constructor(readonly told: EngineError) {
    super(told.problem);
  }
}

function call(name: string, ...values: (string | number)[]): unknown {
  const types = values.map((value) => (typeof value === "string" ? "string" : "number"));
  const answer = JSON.parse(engine.ccall(`vantage_${name}`, "string", types, values) as string);
  if (answer.error) throw new Failed(answer.error);
  return answer;
}

/** With a text on the heap: ccall would put it on the stack, which has 5 MB, with room for four bytes a character. */
function callWith(name: string, text: string): unknown {
  const bytes = new TextEncoder().encode(`${text}\0`);
  const at = engine._malloc(bytes.length);
  try {
    engine.HEAPU8.set(bytes, at);
    return call(name, at);
  } finally {
    engine._free(at);
  }
}

const isThere = (file: string) => engine.FS.analyzePath(file).exists;

const SCENE = 0;
const VOLUME = 1;

function view(which: number): ViewMesh {
  const number = (name: string) => (engine.ccall(`vantage_${name}`, "number", ["number"], [which]) as number) >>> 0;
  const positions = number("positions") / 4;
  const triangles = number("triangles") / 4;
  const labels = number("labels") / 4;
  return {
    positions: engine.HEAPF32.slice(positions, positions + number("position_count")),
    triangles: engine.HEAPU32.slice(triangles, triangles + number("triangle_count")),
    labels: engine.HEAPU32.slice(labels, labels + number("label_count")),
  };
}

/** Files that missions in the scene may name. */
let beside = new Map<string, Uint8Array>();

/** A scene that cannot be opened does not replace the last one, nor its files. */
function open({ text, file, files }: Extract<Request, { call: "open" }>): Omit<Answer, "id" | "engine_ms"> {
  const given = new Map(Object.entries(files).map(([name, bytes]) => [name, new Uint8Array(bytes)]));
  for (const [name, bytes] of given) engine.FS.writeFile(name, bytes);
  let kept = beside;
  try {
    const value = callWith("open", text);
    given.delete(file);
    kept = given;
    return { value, mesh: view(SCENE) };
  } finally {
    for (const name of [...Object.keys(files), ...beside.keys()]) if (isThere(name)) engine.FS.unlink(name);
    for (const [name, bytes] of kept) engine.FS.writeFile(name, bytes);
    beside = kept;
  }
}

function query(points: number[][]): unknown {
  const coordinates = points.flat();
  const at = engine._malloc(8 * coordinates.length);
  try {
    engine.HEAPF64.set(coordinates, at / 8);
    return call("query", at, coordinates.length);
  } finally {
    engine._free(at);
  }
}

function save(format: string): Uint8Array {
  const { size } = call("save", format) as { size: number };
  const at = (engine.ccall("vantage_bytes", "number", [], []) as number) >>> 0;
  return engine.HEAPU8.slice(at, at + size);
}

async function answer(request: Request): Promise<Omit<Answer, "id" | "engine_ms">> {
  switch (request.call) {
    case "start":
      engine = await createVantage({ wasmBinary: request.wasm });
      return {};
    case "about":
      return { value: call("about") };
    case "open":
      return open(request);
    case "compute": {
      const value = callWith("compute", request.text);
      return { value, mesh: view(VOLUME) };
    }
    case "read":
      return { value: callWith("read", request.text) };
    case "query":
      return { value: query(request.points) };
    case "prove":
      return { value: call("prove") };
    case "hello":
    case "shown":
    case "area":
    case "flight":
    case "volumes":
    case "stop":
      throw new Error("only the engine of the program answers this");
    case "slice":
      return { value: call("slice", request.z) };
    case "save":
      return { bytes: save(request.format) };
  }
}

const waiting: Envelope[] = [];
let isWorking = false;
const turn = new MessageChannel();

/** Of volumes only the newest that waits is computed. What was sent meanwhile is taken before the next one begins. */
onmessage = ({ data }) => {
  if (data.request.call === "compute") {
    for (const { id } of waiting.filter(({ request }) => request.call === "compute")) postMessage({ id, stale: true, engine_ms: 0 }, []);
    const others = waiting.filter(({ request }) => request.call !== "compute");
    waiting.splice(0, waiting.length, ...others);
  }
  waiting.push(data);
  if (!isWorking) turn.port2.postMessage(null);
};

turn.port1.onmessage = async () => {
  const next = isWorking ? undefined : waiting.shift();
  if (!next) return;
  isWorking = true;
  await work(next);
  isWorking = false;
  if (waiting.length > 0) turn.port2.postMessage(null);
};

async function work({ id, request }: Envelope): Promise<void> {
  const start = performance.now();
  let told: Omit<Answer, "id" | "engine_ms">;
  try {
    told = await answer(request);
  } catch (error) {
    const problem = error instanceof Error ? error.message : String(error);
    told = {
      error: error instanceof Failed ? error.told
        : { code: "internal", problem, where: "", fix: "please report this, with the mission" },
    };
  }
  const buffers = [told.bytes?.buffer, told.mesh?.positions.buffer, told.mesh?.triangles.buffer, told.mesh?.labels.buffer];
  postMessage({ id, ...told, engine_ms: performance.now() - start }, buffers.filter((b) => b !== undefined) as Transferable[]);
}
