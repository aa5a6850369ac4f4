/** The engine's file, which lies beside this one: bundlers take it along. */
export async function readWasm(): Promise<ArrayBuffer> {
  const address = new URL("./vantage.wasm", import.meta.url);
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${address.href}: ${answer.status} ${answer.statusText}`);
  return answer.arrayBuffer();
}
