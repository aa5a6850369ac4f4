// What is said of a volume, without a page.
import { expect, test } from "@playwright/test";
import type { PointAnswer, VolumeInfo } from "../src/engine/messages";
import { boundaryShares, causeText, claimText, emptyText, pointText, proofText, seenFrom, volumeNumbers } from "../src/model/volume";

const info = (parts: Partial<VolumeInfo>) => ({
  outcome: "computed", reason: "", hint: "", volume_m3: 1234567.8, facets: 12, resolve_ms: 1, compute_ms: 0.5, ...parts,
}) as VolumeInfo;
const outside: PointAnswer = { inside: false, margin_m: -1, blocked_by: [], out_of_range: false, behind_target: false, outside_of: [] };

test("a volume claims no more than what is so", () => {
  expect(seenFrom(info({}))).toBe("all of the target");
  expect(seenFrom(info({ claim: { visible: 0.29999, combine: "all" } }))).toBe("at least 29.9 % of the target");
  expect(claimText(info({ claim: { visible: 1, combine: "any" } }))).toContain("all of at least one of the targets");
  expect(claimText(info({ outcome: "blocked_at_once" }))).toBe("");
  expect(emptyText(info({ reason: "hidden" }))).toBe("No position sees all of the target: hidden.");
});

test("a point is told all that keeps it outside", () => {
  expect(pointText(info({}), { ...outside, inside: true })).toContain("Inside");
  expect(pointText(info({}), { ...outside, blocked_by: ["a", "b"], out_of_range: true })).toBe("Outside: hidden by a, b; out of range");
  expect(pointText(info({}), outside)).toContain("not all of the target");
});

test("only a proof says that it is proved", () => {
  expect(proofText(info({}), { verdict: "proved", claims: [] })).toContain("Proved: every position");
  expect(proofText(info({}), { verdict: "not_proved", claims: [] })).toBe("The proof says: not proved");
});

test("shares of the surface begin with the largest", () => {
  const shares = boundaryShares(new Map([["range", 0.5], ["scene", 99.5]]));
  expect(shares.map(({ kind }) => kind)).toEqual(["scene", "range"]);
  expect(shares[1]!.text).toContain("< 1 %");
});

test("a facet is told its cause, by name where the name says more", () => {
  expect(causeText({ kind: "scene", name: "town_hall" })).toBe("hidden by town hall");
  expect(causeText({ kind: "range", name: "range" })).toBe("the range");
});

test("numbers of a volume that was read have no time", () => {
  expect(volumeNumbers(info({}), [0, 20.04], true)).toEqual([
    ["Volume", "1,234,568 m³"], ["Heights", "0 m to 20 m"], ["Facets", "12, while it is dragged"], ["Computed in", "1.5 ms"],
  ]);
  expect(volumeNumbers(info({ facets: 0, compute_ms: 0 }), [0, 0], false).map(([name]) => name)).toEqual(["Volume", "Facets"]);
});
