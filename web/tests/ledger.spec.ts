// What the scene's source has and the scene has not: listed, and drawn hatched.
import { expect } from "@playwright/test";
import { openExample, plazaMesh, settled, test } from "./support";

const WORST = [
  { name: "relation/9", what: "relation", reason: "a member is missing", instead: "", held: false, may_be_larger: false,
    rings: [[[-60, -60], [-40, -60], [-40, -40], [-60, -40]]], low: 0, high: 20 },
  { name: "posts without a height", what: "posts without a height", reason: "they are void", instead: "", held: false, may_be_larger: false,
    rings: [], low: 0, high: 38 },
  { name: "way/7 inn", what: "building=yes", reason: "its ring is open", instead: "its outline, 12 m high", held: true, may_be_larger: true,
    rings: [[[0, 0], [9, 0], [9, 9]]], low: 0, high: 12 },
];

test("what is not built as it stands is listed and drawn hatched", async ({ page }) => {
  await openExample(page);
  await expect(page.locator("#ledger")).toBeHidden();
  const hatched = await page.evaluate(async ({ text, worst }) => {
    const app = (window as any).vantage;
    const bytes = await new Blob([text]).arrayBuffer();
    const { info, mesh } = await app.engine.open("scene: {mesh: scene.obj}\n", { "scene.obj": bytes }, "scene.obj");
    if (info.ledger.count !== 0) throw new Error("a mesh that is whole has a ledger");
    const inn = info.objects.findIndex(({ name }: any) => name === "inn");
    info.objects[inn].kind = "stand-in";
    app.showScene({ ...info, hash: "other", ledger: { count: 1200, held: 900, worst } }, mesh);
    await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    return { standIns: app.city.hatchedCorners / 3, ofInn: mesh.labels.filter((label: number) => label === inn).length, open: app.ledger.count };
  }, { text: plazaMesh.text, worst: WORST });
  await settled(page);
  expect(hatched.standIns).toBe(hatched.ofInn);
  expect(hatched.ofInn).toBeGreaterThan(5);
  expect(hatched.open).toBe(1);
  const ledger = page.locator("#ledger");
  await expect(ledger).toBeVisible();
  await expect(page.locator("#ledger-count")).toContainText("1200");
  await expect(page.locator("#ledger-count")).toContainText("900");
  const lines = page.locator("#ledger-list li");
  await expect(lines).toHaveCount(4);
  await expect(lines.nth(0)).toHaveText("relation/9 (relation): a member is missing; nothing holds its place");
  await expect(lines.nth(1)).toContainText("posts without a height: they are void");
  await expect(lines.nth(2)).toContainText("instead: its outline, 12 m high, and it may be larger");
  await expect(lines.nth(3)).toContainText("1197 more");
  if (process.env.PICTURES) await page.screenshot({ path: `${process.env.PICTURES}/ledger.png` });
});
