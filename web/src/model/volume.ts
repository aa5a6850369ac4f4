// A volume in words: what its positions see, what bounds it, how large it is.
import type { PointAnswer, Proof, VolumeInfo } from "../engine/messages";
import { large, metres } from "./quantity";

const KIND_NAMES: Record<string, string> = {
  scene: "a building begins to hide it", range: "the longest range", target_plane: "the target's plane",
  navigation: "flight limits and boxes", sensor: "the camera", unknown: "not told by the file of the volume",
};

const CAUSE_TEXTS: Record<string, string> = {
  scene: "hidden by", range: "the range", target_plane: "the target's plane", navigation: "where you may fly:", sensor: "the sensor:",
  unknown: "the file of the volume does not say what bounds it",
};

/** What bounds the volume at one facet: "hidden by the tower". */
export function causeText({ kind, name }: { kind: string; name: string }): string {
  const isNamed = kind === "scene" || kind === "navigation" || kind === "sensor";
  return `${CAUSE_TEXTS[kind] ?? kind}${isNamed ? ` ${name.replaceAll("_", " ")}` : ""}`;
}

/** What each position of a volume sees: "all of the target". */
export function seenFrom({ claim }: VolumeInfo): string {
  const visible = claim?.visible ?? 1;
  // Rounded down: what is claimed is no more than what is so.
  const share = visible < 1 ? `at least ${Number((Math.floor(visible * 1000) / 10).toFixed(1))} %` : "all";
  return `${share} of ${claim?.combine === "any" ? "at least one of the targets" : "the target"}`;
}

/** What all positions of the volume have in common; "" where there is no position. */
export function claimText(info: VolumeInfo): string {
  return info.outcome === "computed" ? `Every position in the volume sees ${seenFrom(info)}.` : "";
}

/** Why there is no position. */
export const emptyText = (info: VolumeInfo) => `No position sees ${seenFrom(info)}: ${info.reason}.`;

/** Whether a point lies in the volume, and if not, why. */
export function pointText(info: VolumeInfo, answer: PointAnswer): string {
  if (answer.inside) return `Inside: this position sees ${seenFrom(info)}`;
  const why = [
    answer.blocked_by.length > 0 ? `hidden by ${answer.blocked_by.join(", ")}` : "",
    answer.out_of_range ? "out of range" : "",
    answer.behind_target ? "behind the target" : "",
    answer.outside_of.length > 0 ? `outside of ${answer.outside_of.join(", ")}` : "",
  ].filter((text) => text !== "");
  return `Outside: ${why.join("; ") || "not all of the target is visible"}`;
}

export function proofText(info: VolumeInfo, { verdict }: Proof): string {
  return verdict === "proved" ? `Proved: every position of this volume sees ${seenFrom(info)}.`
    : `The proof says: ${verdict.replaceAll("_", " ")}`;
}

/** The kinds of causes and their shares of the surface, the largest first. `areas`: square metres of each kind. */
export function boundaryShares(areas: ReadonlyMap<string, number>): { kind: string; text: string }[] {
  const whole = [...areas.values()].reduce((a, b) => a + b, 0);
  return [...areas].sort((a, b) => b[1] - a[1]).map(([kind, area]) => {
    const share = (100 * area) / whole;
    return { kind, text: `${KIND_NAMES[kind] ?? kind}, ${share < 1 ? "< 1" : Math.round(share)} %` };
  });
}

/** Its numbers, by their names. `heights`: lowest and highest z; `isDraft`: of a target that is being dragged. */
export function volumeNumbers(info: VolumeInfo, heights: readonly [number, number], isDraft: boolean): [string, string][] {
  const rows: [string, string][] = [["Volume", `${large(info.volume_m3)} m³`]];
  if (info.facets > 0) rows.push(["Heights", `${metres(heights[0])} to ${metres(heights[1])}`]);
  rows.push(["Facets", `${large(info.facets)}${isDraft ? ", while it is dragged" : ""}`]);
  // Not of a volume that was read from a file.
  if (info.compute_ms > 0) rows.push(["Computed in", `${Math.max(0.1, info.resolve_ms + info.compute_ms).toFixed(1)} ms`]);
  return rows;
}
