// Fingers in the place of a mouse and a keyboard.
import { expect, type Page } from "@playwright/test";
import { mission, onScreen, openExample, settled, test } from "./support";

test.use({ hasTouch: true });
test.beforeEach(({ page }) => openExample(page));

/** Fingers by their numbers: they go down, move, and come up where a list lacks them. */
async function fingers(page: Page): Promise<(...points: { id: number; x: number; y: number }[]) => Promise<void>> {
  const session = await page.context().newCDPSession(page);
  let down = 0;
  return async (...touchPoints) => {
    const type = touchPoints.length > down ? "touchStart" : touchPoints.length === 0 ? "touchEnd" : "touchMove";
    down = touchPoints.length;
    await session.send("Input.dispatchTouchEvent", { type, touchPoints });
  };
}

test("a second finger does not take the corner from the first", async ({ page }) => {
  const before = (await mission(page)).target.vertices;
  const { x, y } = await onScreen(page, before[0]);
  const touch = await fingers(page);
  await touch({ id: 1, x, y });
  await touch({ id: 1, x: x + 6, y: y + 3 });
  await touch({ id: 1, x: x + 6, y: y + 3 }, { id: 2, x: x - 150, y: y - 90 });
  await touch({ id: 1, x: x + 8, y: y + 4 }, { id: 2, x: x - 160, y: y - 90 });
  await touch({ id: 1, x: x + 8, y: y + 4 });
  await touch({ id: 1, x: x + 14, y: y + 6 });
  await touch();
  await settled(page);
  const state = await page.evaluate(() => {
    const { isDraft, isDragged, stage } = (window as any).vantage;
    return { isDraft, isDragged, isEnabled: stage.controls.enabled };
  });
  expect(state).toEqual({ isDraft: false, isDragged: false, isEnabled: true });
  const { vertices } = (await mission(page)).target;
  expect(vertices[0]).not.toEqual(before[0]);
  expect(vertices.slice(1)).toEqual(before.slice(1));
  const at = await onScreen(page, vertices[0]);
  expect(Math.hypot(at.x - x - 14, at.y - y - 6)).toBeLessThan(2);
});

test("two fingers zoom, also where the first is on a corner or on the target", async ({ page }) => {
  const before = (await mission(page)).target.vertices as number[][];
  const distance = () => page.evaluate(() => {
    const { camera, controls } = (window as any).vantage.stage;
    return camera.position.distanceTo(controls.target) as number;
  });
  const middle = before.reduce((sum, v) => sum.map((c, i) => c + v[i]! / before.length), [0, 0, 0]);
  for (const place of [before[0]!, middle]) {
    const from = await distance();
    const { x, y } = await onScreen(page, place);
    const touch = await fingers(page);
    await touch({ id: 1, x, y });
    await touch({ id: 1, x: x + 2, y: y - 2 });
    await touch({ id: 1, x: x + 2, y: y - 2 }, { id: 2, x: x - 60, y });
    for (let i = 1; i <= 5; ++i) await touch({ id: 1, x: x + 2 + 8 * i, y }, { id: 2, x: x - 60 - 8 * i, y });
    await touch();
    await settled(page);
    expect(await distance()).toBeLessThan(0.8 * from);
    expect((await mission(page)).target.vertices).toEqual(before);
    // What comes after it is of one finger again.
    const [a] = (await mission(page)).target.vertices;
    const at = await onScreen(page, a);
    await touch({ id: 1, ...at });
    await touch({ id: 1, x: at.x + 20, y: at.y + 9 });
    await touch();
    await settled(page);
    const moved = (await mission(page)).target.vertices;
    expect(moved[0]).not.toEqual(a);
    expect(moved.slice(1)).toEqual(before.slice(1));
    await page.evaluate(() => (window as any).vantage.step((window as any).vantage.history.undo()));
    await settled(page);
  }
});

test("a drag ends where its mission is replaced", async ({ page }) => {
  const { vertices } = (await mission(page)).target;
  const { x, y } = await onScreen(page, vertices[0]);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 9, y + 5);
  await settled(page);
  await page.evaluate(() => (window as any).vantage.openMission(
    "target: {vertices: [[-8, -8, 0], [4, -8, 0], [4, 3, 0]]}\nsensor: {max_range: 90}\n"));
  await page.mouse.move(x + 20, y + 9);
  await page.mouse.up();
  await settled(page);
  expect((await mission(page)).target.vertices).toEqual([[-8, -8, 0], [4, -8, 0], [4, 3, 0]]);
  expect(await page.evaluate(() => (window as any).vantage.stage.controls.enabled)).toBe(true);
});

test("a corner is removed, and the probe raised, without a keyboard", async ({ page }) => {
  for (const id of ["#remove-corner", "#probe-up", "#probe-down"]) await expect(page.locator(id)).toBeHidden();
  const before = (await mission(page)).target.vertices;
  const { x, y } = await onScreen(page, before[0]);
  const touch = await fingers(page);
  await touch({ id: 1, x, y });
  await touch({ id: 1, x: x + 6, y: y + 3 });
  await touch();
  await settled(page);
  await page.locator("#remove-corner").tap();
  await settled(page);
  expect((await mission(page)).target.vertices).toEqual(before.slice(1));
  await expect(page.locator("#remove-corner")).toBeHidden();
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  const height = () => page.evaluate(() => (window as any).vantage.probe.at[2] as number);
  await page.locator("#probe-up").tap();
  expect(await height()).toBeGreaterThan(30);
  await page.locator("#probe-down").tap();
  expect(await height()).toBeCloseTo(30, 6);
  await page.locator("#remove-probe").tap();
  await expect(page.locator("#probe-up")).toBeHidden();
});

test("a finger that scrolls the panel leaves the limits that it touches", async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  const before = (await mission(page)).altitude;
  const slider = page.locator("#high");
  await slider.scrollIntoViewIfNeeded();
  const { x, y, width, height } = (await slider.boundingBox())!;
  const touch = await fingers(page);
  const at = { id: 1, x: x + width * 0.2, y: y + height / 2 };
  await touch(at);
  for (let i = 1; i <= 10; ++i) await touch({ ...at, y: at.y - 12 * i });
  await touch();
  await settled(page);
  expect((await mission(page)).altitude).toEqual(before);
});

test("a long computation says that what is shown is the last volume", async ({ page }) => {
  await page.evaluate(() => {
    const app = (window as any).vantage;
    const ask = app.engine.transport.ask.bind(app.engine.transport);
    app.engine.transport.ask = (request: unknown) => new Promise((done) => setTimeout(() => done(ask(request)), 1500));
    app.edit((m: any) => (m.maxRange = 40), true);
  });
  await expect(page.locator("#hint")).toContainText("still the last volume");
  await settled(page);
  await expect(page.locator("#hint")).toBeHidden();
});
