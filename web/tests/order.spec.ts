// Answers that come late, and missions that are opened while something else is computed.
import { expect, type Page } from "@playwright/test";
import { hideVolume, mission, onScreen, open, openExample, settled, test, volume } from "./support";

test.beforeEach(({ page }) => openExample(page));

const SQUARE = "target: {vertices: [[-8, -8, 0], [4, -8, 0], [4, 3, 0], [-8, 3, 0]]}\nsensor: {max_range: 90}\n";
const BROKEN = "target: {vertices: [[-8, -8, 0], [4, -8, 0], [4, 3, 0]]}\nsensor: {max_rang: 90}\n";

/** Keeps the engine's answers back. release() gives them to the page, in their order, each as an event of its own. */
async function hold(page: Page): Promise<{ answered(count: number): Promise<void>; release(): Promise<void> }> {
  await page.evaluate(() => {
    const { transport } = (window as any).vantage.engine;
    const ask = transport.ask.bind(transport);
    const gate = { answered: 0, open: () => {}, last: Promise.resolve() as Promise<unknown> };
    gate.last = new Promise<void>((resolve) => (gate.open = resolve));
    (window as any).gate = gate;
    transport.ask = (request: unknown) => {
      const answer = ask(request);
      const count = () => void ++gate.answered;
      answer.then(count, count);
      const turn = gate.last.then(() => answer).then(() => {}, () => {}).then(() => new Promise((next) => setTimeout(next, 20)));
      gate.last = turn;
      return turn.then(() => answer);
    };
  });
  return {
    answered: (count) => expect.poll(() => page.evaluate(() => (window as any).gate.answered as number)).toBe(count),
    release: () => page.evaluate(() => (window as any).gate.open()),
  };
}

const openBody = (page: Page, body: string) => page.evaluate((text) => {
  (window as any).opened = (window as any).vantage.openMission(text).then(() => "opened", (error: Error) => error.message);
}, body);
const opened = (page: Page) => page.evaluate(() => (window as any).opened as Promise<string>);
const edit = (page: Page, range: number) => page.evaluate((value) => (window as any).vantage.edit((m: any) => (m.maxRange = value), true), range);

/** That the volume which is shown is the one that the engine has, of the mission as it is. */
async function agrees(page: Page): Promise<void> {
  await settled(page);
  const [saved, shown] = await page.evaluate(async () => {
    const app = (window as any).vantage;
    const bytes: Uint8Array = await app.engine.save("stl");
    return [new DataView(bytes.buffer, bytes.byteOffset).getUint32(80, true), app.volume.info.facets as number];
  });
  expect(saved).toBe(shown);
}

test("what is edited while a mission is opened wins over it", async ({ page }) => {
  const before = await mission(page);
  const { answered, release } = await hold(page);
  await openBody(page, SQUARE);
  await answered(1);
  await edit(page, 40);
  await answered(2);
  await release();
  expect(await opened(page)).toContain("open it again");
  await settled(page);
  expect(await mission(page)).toEqual({ ...before, maxRange: 40 });
  const { radius, target } = await page.evaluate(() => {
    const { info } = (window as any).vantage.volume;
    return { radius: info.range_m as number, target: info.target[0] as number[][] };
  });
  expect(radius).toBe(40);
  expect(target).toEqual(before.target.vertices);
  await agrees(page);
});

test("where what was edited meanwhile has no volume, the one that is shown is the engine's again", async ({ page }) => {
  const before = await volume(page);
  const { answered, release } = await hold(page);
  await openBody(page, SQUARE);
  await answered(1);
  await page.evaluate(() => (window as any).vantage.edit(
    (m: any) => (m.target = { kind: "polygon", vertices: [[-9, -9, 0], [9, -9, 0], [0, -6, 0], [-9, 9, 0]] }), true));
  await release();
  expect(await opened(page)).toContain("open it again");
  await agrees(page);
  expect(await volume(page)).toBe(before);
  await expect(page.locator("#status")).toContainText("no volume of this target");
});

test("a mission that cannot be opened does not swallow what was edited before", async ({ page }) => {
  await page.evaluate(() => {
    const { transport } = (window as any).vantage.engine;
    const ask = transport.ask.bind(transport);
    let isFirst = true;
    // Waits in the engine's queue, till the next one takes its place.
    transport.ask = (request: { call: string }) => {
      if (request.call !== "compute" || !isFirst) return ask(request);
      isFirst = false;
      return new Promise((resolve) => setTimeout(() => resolve({ stale: true, engine_ms: 0 }), 20));
    };
  });
  await edit(page, 40);
  await openBody(page, BROKEN);
  expect(await opened(page)).toContain("max_rang");
  await expect.poll(() => page.evaluate(() => (window as any).vantage.volume.info.range_m as number)).toBe(40);
  await agrees(page);
});

test("what is computed for a target that is gone is not shown with the next one", async ({ page }) => {
  await page.evaluate(() => {
    const app = (window as any).vantage;
    app.seen = [];
    const { show } = app.volumeView;
    app.volumeView.show = (info: any, view: any) => {
      app.seen.push(info.range_m);
      show.call(app.volumeView, info, view);
    };
  });
  const { answered, release } = await hold(page);
  await edit(page, 40);
  await answered(1);
  await page.evaluate(() => {
    const app = (window as any).vantage;
    const { target } = app.mission;
    app.edit((m: any) => (m.target = null), true);
    app.edit((m: any) => Object.assign(m, { target, maxRange: 50 }), true);
  });
  await release();
  await expect.poll(() => page.evaluate(() => (window as any).vantage.volume?.info.range_m as number)).toBe(50);
  expect(await page.evaluate(() => (window as any).vantage.seen)).toEqual([50]);
});

test("where there is no target any more, nothing of its volume is left", async ({ page }) => {
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  await expect(page.locator("#hint")).toContainText("Inside");
  await page.locator("#cut").fill("20");
  await expect(page.locator("#cut-out")).toContainText("m²");
  await page.evaluate(() => (window as any).vantage.edit(
    (m: any) => (m.target = { kind: "polygon", vertices: [[-9, -9, 0], [9, -9, 0], [0, -6, 0], [-9, 9, 0]] }), true));
  await expect(page.locator("#status")).toContainText("no volume of this target");
  await page.evaluate(() => (window as any).vantage.edit((m: any) => (m.target = null), true));
  await settled(page);
  await expect(page.locator("#status")).toHaveText("No target yet");
  await expect(page.locator("#cut-out")).not.toContainText("m²");
  await expect(page.locator("#hint")).toBeHidden();
  const left = await page.evaluate(() => {
    const { sectionView, probeView, isDraft } = (window as any).vantage;
    return [sectionView.lines.geometry.getAttribute("position").count, probeView.group.visible, isDraft];
  });
  expect(left).toEqual([0, false, false]);
});

test("the outline of a cut goes with its volume", async ({ page }) => {
  await page.locator("#cut").fill("20");
  await expect(page.locator("#cut-out")).toContainText("m²");
  await page.evaluate(() => ((window as any).vantage.engine.slice = () => new Promise(() => {})));
  await edit(page, 40);
  await settled(page);
  expect(await page.evaluate(() => (window as any).vantage.sectionView.lines.geometry.getAttribute("position").count)).toBe(0);
  await expect(page.locator("#cut-number")).toHaveValue("20 m");
  await expect(page.locator("#cut-out")).toHaveText("");
});

test("a volume that arrives leaves the corners being drawn, and undo takes the last of them back", async ({ page }) => {
  const before = await mission(page);
  await edit(page, 60);
  await settled(page);
  await page.keyboard.press("d");
  for (const at of [[-6, -6, 0], [6, -6, 0], [6, 5, 0]]) {
    const { x, y } = await onScreen(page, at);
    await page.mouse.click(x, y);
  }
  const corners = () => page.evaluate(() => (window as any).vantage.target.editable.length as number);
  expect(await corners()).toBe(3);
  await edit(page, 50);
  await settled(page);
  expect(await corners()).toBe(3);
  await page.keyboard.press("Control+z");
  expect(await corners()).toBe(2);
  await page.click("#undo");
  expect(await corners()).toBe(1);
  await page.keyboard.press("Control+y"); // nothing of the mission under it
  expect(await corners()).toBe(1);
  expect((await mission(page)).maxRange).toBe(50);
  await page.keyboard.press("Control+z"); // no corner is left: the target is shown again
  expect(await corners()).toBe(before.target.vertices.length);
  expect((await mission(page)).maxRange).toBe(50);
  await page.keyboard.press("Control+z");
  await settled(page);
  expect((await mission(page)).maxRange).toBe(60);
});

/** So fine that its volume takes seconds where the range is 60 m, and no time where it is 3. */
const FINE = "target: {vertices: [[-8, -8, 0], [-6, -8, 0], [-7, -6, 0]]}\nsensor: {max_range: 3}\nexact: {tolerance: 0.00001}\n";

/** Of a page that is drawn while others compute: it may hear nothing for seconds. */
const BUSY = { timeout: 30_000 };

test("what takes long can be stopped, and the last volume stays", async ({ page }) => {
  await hideVolume(page);
  await openBody(page, FINE);
  expect(await opened(page)).toBe("opened");
  const before = await volume(page);
  for (const stop of [() => page.click("#stop"), () => page.keyboard.press("Escape")]) {
    await edit(page, 60);
    await expect(page.locator("#hint")).toContainText("still the last volume", BUSY);
    await stop();
    await expect(page.locator("#hint")).toContainText("stopped", BUSY);
    await expect(page.locator("#stop")).toBeHidden(BUSY);
    await expect(page.locator("#status")).toContainText("stopped", BUSY);
    await expect(page.locator("#fault")).toBeHidden();
    await agrees(page);
    await expect(page.locator("#hint")).toContainText("stopped"); // also where the last volume was computed again meanwhile
    expect(await volume(page)).toBe(before);
    expect((await mission(page)).maxRange).toBe(60);
  }
  await page.click("#compute"); // after all
  await page.click("#stop");
  await expect(page.locator("#compute")).toBeVisible();
  await edit(page, 4);
  await agrees(page);
  expect(await volume(page)).toBeGreaterThan(before);
  await expect(page.locator("#hint")).toBeHidden();
  await expect(page.locator("#compute")).toBeHidden();
});

test("a proof can be stopped, and run again", async ({ page }) => {
  await hideVolume(page);
  await openBody(page, FINE.replace("max_range: 3", "max_range: 8"));
  expect(await opened(page)).toBe("opened");
  await page.click("#prove");
  await page.click("#stop");
  await expect(page.locator("#proof")).toContainText("stopped");
  await page.click("#prove"); // also while the worker has no volume again yet
  await expect(page.locator("#proof")).toContainText("Proved", { timeout: 30_000 });
  await agrees(page);
});

test("what waits behind what is stopped is stopped, too", async ({ page }) => {
  await hideVolume(page);
  await openBody(page, FINE);
  expect(await opened(page)).toBe("opened");
  const before = await volume(page);
  await edit(page, 60);
  await edit(page, 59);
  await page.click("#stop");
  await expect(page.locator("#status")).toContainText("stopped");
  await agrees(page);
  expect([await volume(page), (await mission(page)).maxRange]).toEqual([before, 59]);
});

test("a mission that takes long to open can be stopped, and the one that was there stays", async ({ page }) => {
  const before = [await volume(page), await mission(page)];
  await hideVolume(page);
  await openBody(page, FINE.replace("max_range: 3", "max_range: 60"));
  await page.click("#stop");
  expect(await opened(page)).toContain("stopped");
  await agrees(page);
  expect([await volume(page), await mission(page)]).toEqual(before);
});

test("a scene that takes long to read can be stopped, and the one that was there stays", async ({ page }) => {
  const before = [await volume(page), await mission(page)];
  const side = 700; // a million triangles
  const lines: string[] = [];
  for (let i = 0; i < side * side; ++i) lines.push(`v ${i % side} ${Math.floor(i / side)} ${Math.sin(i)}`);
  for (let i = 0; i < side * (side - 1); ++i) if (i % side < side - 1) lines.push(`f ${i + 1} ${i + 2} ${i + side + 2} ${i + side + 1}`);
  await open(page, { name: "large.obj", text: lines.join("\n") });
  await page.click("#stop");
  await expect(page.locator("#hint")).toContainText("stopped");
  await agrees(page);
  expect([await volume(page), await mission(page)]).toEqual(before);
  await edit(page, 50);
  await agrees(page);
  expect(await volume(page)).toBeLessThan(before[0]);
});
