// Everything that can be edited, and that files keep what the page cannot.
import { expect, type Page } from "@playwright/test";
import { agrees, drag, mission, onScreen, open, openExample, plazaMesh, settled, test, volume } from "./support";

test.beforeEach(({ page }) => openExample(page));

test("limits are typed, between the steps of the sliders and beyond their ends", async ({ page }) => {
  const type = async (id: string, text: string) => {
    await page.locator(`#${id}-number`).fill(text);
    await page.locator(`#${id}-number`).press("Enter");
    await settled(page);
  };
  await type("range", "63.7");
  await type("low", "7,5 m");
  const { range, altitude } = await mission(page);
  expect([range, altitude[0]]).toEqual([63.7, 7.5]);
  await agrees(page);
  // A limit moves no other one: a ceiling is a law.
  const { altitude: [, ceiling] } = await mission(page);
  await type("low", String(ceiling + 10));
  await expect(page.locator("#hint")).toContainText("not possible");
  expect((await mission(page)).altitude).toEqual([7.5, ceiling]);
  await page.locator("#low").fill(String(ceiling + 10));
  expect((await mission(page)).altitude[1]).toBe(ceiling);
  expect((await mission(page)).altitude[0]).toBeLessThan(ceiling);
  await type("low", "any");
  await type("high", "");
  expect((await mission(page)).altitude).toBe(null);
  await expect(page.locator("#high-number")).toHaveValue("any");
  await type("range", "far");
  await expect(page.locator("#hint")).toContainText("a number");
  await expect(page.locator("#range-number")).toHaveValue("63.7 m");
  for (const text of ["0", "-5"]) {
    await type("range", text);
    expect((await mission(page)).range).toBe(63.7);
  }
  await agrees(page);
});

test("a keep-out box has handles", async ({ page }) => {
  const boxes = (await mission(page)).keepOut.length;
  await page.click("#add-box");
  await settled(page);
  const before = (await mission(page)).keepOut[boxes];
  const middle = [0, 1, 2].map((i) => (before.min[i] + before.max[i]) / 2);
  await drag(page, [middle[0]!, middle[1]!, before.max[2]], { x: 0, y: -40 });
  const taller = (await mission(page)).keepOut[boxes];
  expect(taller.max[2]).toBeGreaterThan(before.max[2] + 1);
  expect(taller.min).toEqual(before.min);
  await drag(page, [middle[0]!, middle[1]!, (taller.min[2] + taller.max[2]) / 2], { x: 40, y: 0 });
  const moved = (await mission(page)).keepOut[boxes];
  expect(moved.max[2]).toBe(taller.max[2]);
  const field = page.getByLabel(`box ${boxes + 1}, to x, metres`);
  await field.fill("-80");
  await field.press("Enter");
  await settled(page);
  expect(Number(await field.inputValue())).toBeCloseTo(moved.min[0], 4);
  await field.fill("");
  await field.press("Tab");
  const turned = (await mission(page)).keepOut[boxes];
  expect([turned.min[0], turned.max[0]]).toEqual([-80, moved.min[0]]);
  expect(Math.hypot(moved.min[0] - taller.min[0], moved.min[1] - taller.min[1])).toBeGreaterThan(1);
  await agrees(page);
  await page.locator("#boxes li").nth(boxes).getByRole("button", { name: "Remove" }).click();
  expect((await mission(page)).keepOut).toHaveLength(boxes);
});

test("where a drag ends in a target that is none, the volume that stays is no draft", async ({ page }) => {
  const [corner, , opposite] = (await mission(page)).target.vertices;
  const { x, y } = await onScreen(page, corner);
  const beyond = await onScreen(page, [0, 1, 2].map((i) => 1.2 * opposite[i] - 0.2 * corner[i]));
  const isDraft = () => page.evaluate(() => (window as any).vantage.isDraft);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 6, y + 3);
  await expect.poll(isDraft).toBe(true);
  const facets = await page.evaluate(() => (window as any).vantage.volume.info.facets);
  await page.mouse.move(beyond.x, beyond.y);
  await page.mouse.up();
  await expect.poll(isDraft).toBe(false);
  await expect(page.locator("#status")).toContainText("the volume shown is that of the last valid target");
  expect(await page.evaluate(() => (window as any).vantage.volume.info.facets)).toBeGreaterThan(facets);
});

test("an answer that is late does not hide that the target is none", async ({ page }) => {
  const bad = [[-9, -9, 0], [9, -9, 0], [0, -6, 0], [-9, 9, 0]];
  await page.evaluate((vertices) => {
    const app = (window as any).vantage;
    const moved = structuredClone(app.mission.target.vertices);
    moved[0][0] -= 0.5;
    app.edit((m: any) => (m.target = { kind: "polygon", vertices: moved }), false);
    app.edit((m: any) => (m.target = { kind: "polygon", vertices }), true);
  }, bad);
  await settled(page);
  await expect.poll(() => page.evaluate(() => (window as any).vantage.isDraft)).toBe(false);
  await settled(page);
  await expect(page.locator("#status")).toContainText("the volume shown is that of the last valid target");
  await expect(page.locator("#hint")).toContainText("not convex");
});

test("a double click adds a corner, and Del removes it", async ({ page }) => {
  const { target } = await mission(page);
  const [a, b] = target.vertices;
  const side = await onScreen(page, [0, 1, 2].map((i) => a[i] * 0.5 + b[i] * 0.5));
  await page.mouse.dblclick(side.x, side.y);
  await expect.poll(async () => (await mission(page)).target.vertices.length).toBe(target.vertices.length + 1);
  await settled(page);
  await page.keyboard.press("Delete");
  await expect.poll(async () => (await mission(page)).target.vertices).toEqual(target.vertices);
});

/** Where the ray of a click meets what is wanted: found on the screen, as a person does. */
const placeOnScreen = (page: Page, wanted: "roof" | "facade" | "ground") =>
  page.evaluate((kind) => {
    const { stage, city } = (window as any).vantage;
    const { width, height, left, top } = stage.canvas.getBoundingClientRect();
    for (let y = 0.2; y < 0.9; y += 0.02) {
      for (let x = 0.1; x < 0.9; x += 0.02) {
        const event = { clientX: left + x * width, clientY: top + y * height };
        const hit = city.hit(stage.ray(event));
        if (!hit || (hit.kind === "ground") !== (kind === "ground")) continue;
        if ((hit.plane.normal[2] > 0.9) !== (kind === "facade") && hit.plane.normal[2] > -0.1) return { ...event, point: hit.point };
      }
    }
    return null;
  }, wanted);

test("a roof and a wall are picked", async ({ page }) => {
  for (const part of ["roof", "facade"] as const) {
    const at = await placeOnScreen(page, part);
    await page.keyboard.press("p");
    await page.mouse.click(at!.clientX, at!.clientY);
    await expect.poll(async () => (await mission(page)).target.part).toBe(part);
    await settled(page);
    await agrees(page);
  }
  // It has corners like any other target, once it is there.
  const [corners] = await page.evaluate(() => (window as any).vantage.volume.info.target as number[][][]);
  await drag(page, corners![0]!, { x: 6, y: 4 });
  const { target } = await mission(page);
  expect(target.vertices.slice(1)).toEqual(corners!.slice(1));
  expect(target.vertices[0]).not.toEqual(corners![0]);
});

test("on the ground the flat place around a click is picked", async ({ page }) => {
  const at = await placeOnScreen(page, "ground");
  await page.keyboard.press("p");
  await page.mouse.click(at!.clientX, at!.clientY);
  await expect(page.locator("#hint")).toContainText("The flat place");
  await settled(page);
  const { target } = await mission(page);
  expect(target.kind).toBe("polygon");
  for (const [, , z] of target.vertices) expect(z).toBeCloseTo(0, 6);
  expect(await page.evaluate(() => (window as any).vantage.failure)).toBe("");
  await agrees(page);
});

test("a mission keeps its comments, and keys that the page has no controls for", async ({ page }) => {
  const written = `# the square, for the fair
scene:
  mesh: plaza.obj   # beside this file
# what is seen
target:
  name: square
  vertices: [[-8, -8, 0], [4, -8, 0], [4, 3, 0], [-8, 3, 0]]
  offset: 0.05
sensor:
  max_range: 60 # of the lens
navigation:
  keep_in:
    - {polygon: [[-50, -50], [50, -50], [50, 50], [-50, 50]], z: [2, 80]}
  clearance: 2
exact:
  tolerance: 0.02
`;
  await open(page, { name: "fair.yaml", text: written }, plazaMesh);
  await expect.poll(async () => (await mission(page)).range).toBe(60);
  await settled(page);
  const unchanged = await agrees(page);
  for (const line of ["# beside this file", "# what is seen", "# of the lens", "clearance: 2", "tolerance: 0.02", "offset: 0.05"]) expect(unchanged).toContain(line);
  await page.locator("#range").fill("40");
  await settled(page);
  const nearer = await agrees(page);
  expect(nearer).toContain("max_range: 40 # of the lens");
  expect(nearer).toContain("offset: 0.05");
  const { target } = await mission(page);
  await drag(page, target.vertices[2], { x: 12, y: -6 });
  const moved = await agrees(page);
  expect(moved).not.toContain("offset");
  expect(moved).toContain("clearance: 2");
});

test("a mission of several polygons is shown, and drawn anew as one", async ({ page }) => {
  const text = `scene: {mesh: plaza.obj}
targets:
  - {name: a, vertices: [[-8, -8, 0], [-4, -8, 0], [-4, -3, 0]]}
  - {name: b, vertices: [[2, 2, 0], [6, 2, 0], [6, 5, 0]]}
sensor: {max_range: 60}
`;
  await open(page, { name: "two.yaml", text }, plazaMesh);
  await expect.poll(async () => (await mission(page)).target?.kind).toBe("written");
  await settled(page);
  await agrees(page);
  await page.locator("#range").fill("45");
  await settled(page);
  expect(await agrees(page)).toContain("name: b");
  await page.keyboard.press("d");
  for (const at of [[-5, -5, 0], [5, -5, 0], [5, 4, 0]]) {
    const { x, y } = await onScreen(page, at);
    await page.mouse.click(x, y);
  }
  await page.keyboard.press("Enter");
  await expect.poll(async () => (await mission(page)).target?.kind).toBe("polygon");
  await settled(page);
  expect(await agrees(page)).not.toContain("targets");
});

test("a camera limits the volume by its angles, its tilt and its pixels", async ({ page }) => {
  const before = await volume(page);
  const options = await page.locator("#camera option").count();
  expect(options).toBeGreaterThan(5);
  await page.locator("#camera").selectOption({ index: 1 });
  await settled(page);
  const seen = await volume(page);
  expect(seen).toBeLessThanOrEqual(before);
  await page.locator("#tilt").fill("-90");
  await settled(page);
  const down = await volume(page);
  expect(down).toBeLessThan(seen);
  await page.selectOption("#pixel", "0.01");
  await settled(page);
  const sharp = await volume(page);
  expect(sharp).toBeGreaterThan(0);
  expect(sharp).toBeLessThan(down);
  expect(await agrees(page)).toContain("pitch: -90");
  await page.selectOption("#camera", "");
  await settled(page);
  expect(await volume(page)).toBe(before);
});

test("the eye flies with the view, and comes back", async ({ page }) => {
  await page.evaluate(() => (window as any).vantage.setProbe([0, 0, 30]));
  const camera = () => page.evaluate(() => (window as any).vantage.stage.camera.position.toArray() as number[]);
  const before = await camera();
  await page.click("#see");
  await expect(page.locator("#see")).toHaveAttribute("aria-pressed", "true");
  const box = (await page.locator("#canvas").boundingBox())!;
  await page.mouse.move(box.x + 100, box.y + box.height - 60);
  await page.mouse.down();
  await page.mouse.move(box.x + 300, box.y + box.height - 100, { steps: 5 });
  await page.mouse.up();
  const probe = await page.evaluate(() => (window as any).vantage.probe.at as number[]);
  expect(Math.hypot(probe[0]!, probe[1]!)).toBeGreaterThan(0.5);
  await expect(page.locator("#hint")).toContainText(/Inside|Outside/);
  await page.locator("#canvas").focus();
  await page.keyboard.press("PageUp");
  expect((await page.evaluate(() => (window as any).vantage.probe.at[2])) as number).toBeGreaterThan(probe[2]!);
  await page.keyboard.press("Escape");
  const after = await camera();
  for (const axis of [0, 1, 2]) expect(after[axis]).toBeCloseTo(before[axis]!, 6);
});

test("a target that a wall stands in keeps the last volume, and says so at the corner", async ({ page }) => {
  const before = await volume(page);
  const { target } = await mission(page);
  await page.evaluate((vertices) => {
    const app = (window as any).vantage;
    app.dragged = 1;
    const moved = vertices.map((v: number[], i: number) => (i === 1 ? [v[0]! + 38, v[1]! - 16, v[2]!] : v));
    app.edit((m: any) => (m.target = { kind: "polygon", vertices: moved }), true);
  }, target.vertices);
  await expect(page.locator("#fault")).toBeVisible();
  await expect(page.locator("#hint")).toHaveClass("bad");
  expect(await volume(page)).toBe(before);
  await page.keyboard.press("Control+z");
  await expect(page.locator("#fault")).toBeHidden();
});
