// Links: a mission, and the scene where it is small, as a text in an address: JSON, compressed, in base64 as addresses
// take it (RFC 4648, 5).

const LARGEST_IN_LINK = 12e3; // characters: longer links are cut by mail and chat programs
const LARGEST_UNPACKED = 8e6; // bytes: a few characters can be made to unpack to gigabytes

/** Bytes of a mission file: the engine takes no more. */
export const LARGEST_MISSION = 2 ** 20;

export interface Link {
  /** name of its file */
  scene: string;
  section: Record<string, unknown>;
  mission: string;
  /** of the scene; older links lack it */
  hash?: string;
  /** the scene is the example, which every page has */
  isExample?: boolean;
  /** base64, of a scene that is small enough */
  bytes?: string;
}

/** The text of a link, with the bytes of its scene if they are given and few; whether it holds all that is needed. */
export async function written(link: Link, bytes: ArrayBuffer | null): Promise<{ text: string; isWhole: boolean }> {
  if (bytes && bytes.byteLength <= 20 * LARGEST_IN_LINK) {
    const text = await packed(JSON.stringify({ ...link, bytes: base64(new Uint8Array(bytes)) }));
    if (text.length <= LARGEST_IN_LINK) return { text, isWhole: true };
  }
  return { text: await packed(JSON.stringify(link)), isWhole: link.isExample ?? false };
}

/** Throws where a part is missing or was changed: gzip ends with a sum of what it holds. */
export async function read(text: string): Promise<Link> {
  let link: Link;
  try {
    link = JSON.parse(await unpacked(text)) as Link;
    if (typeof link.scene !== "string" || typeof link.mission !== "string" || typeof (link.section ??= {}) !== "object") {
      throw new Error("not a link of this page");
    }
  } catch (error) {
    throw error instanceof TooLong ? error : new Error("the link is cut short or damaged");
  }
  if (new Blob([link.mission]).size > LARGEST_MISSION) throw new TooLong();
  return link;
}

class TooLong extends Error {
  constructor() {
    super("the mission of this link is too long: it may have 1 MiB");
  }
}

export const bytesOf = (text: string): ArrayBuffer => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;

function base64(bytes: Uint8Array): string {
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}

async function packed(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("gzip"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return base64(bytes).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

async function unpacked(text: string): Promise<string> {
  const packed = new Blob([bytesOf(text.replaceAll("-", "+").replaceAll("_", "/"))]);
  const reader = packed.stream().pipeThrough(new DecompressionStream("gzip")).getReader();
  const parts: Uint8Array[] = [];
  let length = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    parts.push(part.value);
    length += part.value.length;
    if (length <= LARGEST_UNPACKED) continue;
    await reader.cancel();
    throw new TooLong();
  }
  return new Blob(parts).text();
}
