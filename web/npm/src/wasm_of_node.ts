// @ts-ignore: Node.js has it; its types are not needed for one function
import { readFile } from "node:fs/promises";

/** The engine's file, which lies beside this one. */
export async function readWasm(): Promise<Uint8Array> {
  return readFile(new URL("./vantage.wasm", import.meta.url));
}
