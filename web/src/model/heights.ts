// Bands of heights. A mission file must give both ends of one: an end that is open is written as a height that no
// position can have, with a comment by which the page knows this number again.
import { isMap, isSeq, type Document, type Node, type YAMLMap, type YAMLSeq } from "yaml";

/** Lowest and highest, metres; null: no limit at this end. */
export type Band = [number | null, number | null];

/** heights of the scene, and those above the ground */
export type BandKey = "z" | "agl";

const PATH = ["navigation", "altitude"];
const LONGEST = 1e7; // metres: longer than any range that follows from a camera, or from how far a pilot sees
const LARGEST = 1e9; // metres: mission files take no larger number

/** What no height of a position reaches; `top`: nor is the scene, its ground or the target farther from 0 than that. */
export function farHeight(top: number, range: number | null): number {
  // A position is within the range of the target, and the ground that is below it may be as low as `top` is high.
  return Math.min(LARGEST, 10 ** Math.ceil(Math.log10(2 * (2 * top + (range ?? LONGEST)))));
}

const markOf = (key: BandKey, height: number) => `${key} ${height}: no limit`;
const isMark = (text: string, key: BandKey) => text.startsWith(`${key} `) && text.endsWith(": no limit");
const notesOf = (node: Node | undefined) => (node?.comment ?? "").split(";").map((note) => note.trim());

/** The band, and what carries its comment: in a map on one line, as {z: [3, 50]}, that is the map. */
function nodesOf(document: Document, key: BandKey): { band: YAMLSeq | undefined; carrier: Node | undefined } {
  const altitude = document.getIn(PATH, true);
  if (!isMap(altitude)) {
    const band = key === "z" && isSeq(altitude) ? (altitude as YAMLSeq) : undefined;
    return { band, carrier: band };
  }
  const own = altitude.get(key, true);
  const band = isSeq(own) ? (own as YAMLSeq) : undefined;
  return { band, carrier: altitude.flow ? (altitude as YAMLMap) : band };
}

/** `read`: what the engine read. Ends are open where the page wrote them, and they limit nothing still. */
export function readBand(document: Document, key: BandKey, read: [number, number] | null, far: number): Band | null {
  if (!read) return null;
  const notes = notesOf(nodesOf(document, key).carrier);
  const [low, high] = read.map((end) => (Math.abs(end) >= far && notes.includes(markOf(key, end)) ? null : end)) as Band;
  return low === null && high === null ? null : [low, high];
}

/** A list holds heights of the scene; those above the ground need a map, which may hold both. */
function makeBand(document: Document, key: BandKey): void {
  const altitude = document.getIn(PATH, true);
  if (isMap(altitude)) return altitude.set(key, document.createNode([0, 0], { flow: true }));
  if (key === "z") return document.setIn(PATH, document.createNode([0, 0], { flow: true }));
  const both = document.createNode({}, { flow: true }) as YAMLMap;
  if (isSeq(altitude)) {
    both.comment = altitude.comment;
    altitude.comment = null;
    both.set("z", altitude);
  }
  both.set(key, document.createNode([0, 0], { flow: true }));
  document.setIn(PATH, both);
}

/** null: its comment alone is taken away; the band is still to be. */
export function writeBand(document: Document, key: BandKey, heights: Band | null, far: number): void {
  if (heights && !nodesOf(document, key).band) makeBand(document, key);
  const { band, carrier } = nodesOf(document, key);
  if (!band || !carrier) return;
  const ends = heights?.map((end, i) => end ?? (i === 0 ? -far : far)) ?? [];
  const old = notesOf(carrier);
  const notes = old.filter((note) => note !== "" && !isMark(note, key));
  heights?.forEach((end, i) => end === null && notes.push(markOf(key, ends[i]!)));
  ends.forEach((end, i) => band.set(i, end));
  if (notes.length > 0) {
    carrier.comment = ` ${notes.join("; ")}`;
    // Where the comment stands at the end of a line of its own, and is read again.
    band.flow = true;
    (document.get("navigation") as YAMLMap).flow = false;
  } else if (old.some((note) => isMark(note, key))) carrier.comment = null;
}
