// SPDX-License-Identifier: BSD-3-Clause
// The transfer function under mouse and finger, and what the check of a mesh says: a server of a mesh that overlaps itself.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { answered, at_rest, hang, launch, missing, serve } from "./support.mjs";

const reason = missing();
if (reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), "tessera-panel-"));
/** Two tetrahedra that share a part of their room, far from the origin, and a third one. */
const file = join(folder, "overlap.vtk");
writeFileSync(file, `# vtk DataFile Version 3.0
overlap
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 12 double
311000 7479000 0  311002 7479000 0  311000 7479002 0  311000 7479000 2
311000.25 7479000.25 0.25  311002.25 7479000.25 0.25  311000.25 7479002.25 0.25  311000.25 7479000.25 2.25
311005 7479000 0  311007 7479000 0  311005 7479002 0  311005 7479000 2
CELLS 3 15
4 0 1 2 3
4 4 5 6 7
4 8 9 10 11
CELL_TYPES 3
10 10 10
POINT_DATA 12
SCALARS height double 1
LOOKUP_TABLE default
0 1 2 3 4 5 6 7 8 9 10 11
`);
let browser, server, page, touched;

async function opened(options) {
  const made = await (await browser.newContext(options)).newPage();
  made.setDefaultTimeout(hang);
  made.errors = [];
  made.on("pageerror", (error) => made.errors.push(error.stack));
  await made.goto((await server.address).href);
  await answered(made);
  return made;
}

before(async () => {
  server = serve([file]);
  browser = await launch();
  page = await opened({ viewport: { width: 1000, height: 760 } });
  touched = await opened({ viewport: { width: 420, height: 800 }, hasTouch: true });
  if (!(await touched.locator("#panel").isVisible())) await touched.getByRole("button", { name: "Settings" }).click();
  await answered(touched);
}, { timeout: hang });

after(async () => {
  await browser?.close();
  server?.child.kill("SIGKILL");
  rmSync(folder, { recursive: true, force: true });
});

const no_errors = () => assert.deepEqual([...page.errors, ...touched.errors], []);

/** A function of four points: two of them so near that each lies within the other's reach. @param {any} on */
async function choose_near_points(on) {
  await on.evaluate(() => window.tessera.change({ "transfer-function": { RGBPoints: [0, 0, 0, 1, 11, 1, 0, 0], Points: [0, 0, 0.5, 0, 5.3, 0.4, 0.5, 0, 5.5, 0.4, 0.5, 0, 11, 0.5, 0.5, 0], ScalarOpacityUnitDistance: 1 }, range: "0,11" }));
  await answered(on);
  await on.locator(".function-editor").scrollIntoViewIfNeeded();
  assert.equal(await on.locator(".opacity-handle").count(), 4);
}
/** Opacities and values of the points. */
const points = (on) => on.evaluate(() => [...document.querySelectorAll(".opacity-handle")].map((point) => [Number(point.getAttribute("aria-valuenow")), Number(/at (\S+)/.exec(point.getAttribute("aria-valuetext"))[1])]));
/** The middle of point `index` on the screen. */
const middle = (on, index) => on.locator(".opacity-handle .dot").nth(index).evaluate((dot) => {
  const { x, y, width, height } = dot.getBoundingClientRect();
  return { x: x + width / 2, y: y + height / 2 };
});

for (const index of [1, 2])
  test(`a press on one of two near points takes that one: ${index}`, async () => {
    await choose_near_points(page);
    const old = await points(page);
    const { x, y } = await middle(page, index);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y - 30, { steps: 4 });
    await page.mouse.up();
    await answered(page);
    const now = await points(page);
    assert.ok(now[index][0] > old[index][0] + 0.05, `${old} became ${now}`);
    assert.deepEqual(now.filter((_, i) => i !== index), old.filter((_, i) => i !== index));
    no_errors();
  });

test("a press on the end's point takes the point, and on its flag the range", async () => {
  await choose_near_points(page);
  const old = await points(page);
  const { x, y } = await middle(page, 3);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - 30, { steps: 4 });
  await page.mouse.up();
  await answered(page);
  assert.ok((await points(page))[3][0] > old[3][0] + 0.05);
  const high = page.getByLabel("High end of the range").and(page.locator("input"));
  const flag = await page.locator(".range-handle path").nth(1).boundingBox();
  await page.mouse.move(flag.x + flag.width / 2, flag.y + flag.height / 2);
  await page.mouse.down();
  await page.mouse.move(flag.x - 40, flag.y + flag.height / 2, { steps: 4 });
  await page.mouse.up();
  await answered(page);
  assert.ok(Number(await high.inputValue()) < 10.5, await high.inputValue());
  no_errors();
});

/** A finger on the screen, through the browser's own handling of gestures. */
async function finger(on) {
  const session = await on.context().newCDPSession(on);
  const at = (type, places) => session.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y]) => ({ x, y })) });
  return { down: (x, y) => at("touchStart", [[x, y]]), move: (x, y) => at("touchMove", [[x, y]]), up: () => at("touchEnd", []), cancel: () => at("touchCancel", []) };
}
const panel_top = () => touched.locator("#panel").evaluate((panel) => panel.scrollTop);

test("a finger moves a point up and down, and the panel stays", async () => {
  await choose_near_points(touched);
  const [old, top] = [await points(touched), await panel_top()];
  const { x, y } = await middle(touched, 1);
  const touch = await finger(touched);
  await touch.down(x, y);
  for (let i = 1; i <= 10; ++i) await touch.move(x, y - 4 * i);
  await touch.up();
  await answered(touched);
  const now = await points(touched);
  assert.ok(now[1][0] > old[1][0] + 0.1 && now[1][0] < 0.9, `${old} became ${now}`);
  assert.ok(Math.abs(now[1][1] - old[1][1]) < 0.2, `${old} became ${now}`);
  assert.equal(await panel_top(), top);
  no_errors();
});

test("next to the points a finger scrolls the panel", async () => {
  const top = await panel_top();
  const box = await touched.locator(".function-editor").boundingBox();
  const touch = await finger(touched);
  const [x, y] = [box.x + 0.3 * box.width, box.y + 0.35 * box.height];
  await touch.down(x, y);
  for (let i = 1; i <= 10; ++i) await touch.move(x, y - 8 * i);
  await touch.up();
  await touched.waitForFunction((old) => document.querySelector("#panel").scrollTop > old, top);
});

test("a drag that the browser takes away goes back to where it began", async () => {
  const state = () => touched.evaluate(() => window.tessera.state());
  const first = await state();
  await choose_near_points(touched);
  const [old, before_drag] = [await points(touched), await state()];
  const { x, y } = await middle(touched, 2);
  const touch = await finger(touched);
  await touch.down(x, y);
  for (let i = 1; i <= 5; ++i) await touch.move(x + 3 * i, y - 6 * i);
  assert.notDeepEqual(await points(touched), old);
  await touch.cancel();
  await answered(touched);
  assert.deepEqual(await points(touched), old);
  assert.deepEqual(await state(), before_drag);
  // It is no step: undo leads to before the points were chosen.
  await touched.evaluate(() => window.tessera.undo());
  await answered(touched);
  assert.deepEqual(await state(), first);
  no_errors();
});

test("of two handles that meet at an end of their slider the one that can move is taken", async () => {
  await page.evaluate(() => window.tessera.change({ clip: ["box:311006.9,7479000,0,311007,7479002.25,2.25"] }));
  await at_rest(page);
  const data = page.locator("details.section", { has: page.locator('summary:text-is("Data")') });
  await data.evaluate((section) => { section.open = true; });
  const slider = data.locator(".clip .double-slider").first();
  await slider.scrollIntoViewIfNeeded();
  const track = await slider.boundingBox();
  await page.mouse.move(track.x + track.width - 8, track.y + track.height / 2);
  await page.mouse.down();
  await page.mouse.move(track.x + 0.5 * track.width, track.y + track.height / 2, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => {
    const [low, , , high] = window.tessera.state().clip[0].slice(4).split(",").map(Number);
    return low < 311005 && high === 311007;
  });
  await page.evaluate(() => window.tessera.change({ clip: undefined }));
  await at_rest(page);
});

test("the check of a mesh is a sentence and a table, and its places are looked at", async () => {
  const information = page.locator("details.section", { has: page.locator('summary:text-is("Information")') });
  await information.evaluate((section) => { section.open = true; });
  await information.getByRole("button", { name: "Check the mesh" }).click();
  await information.getByText(/^1 overlap in 2 cells.*: the image is wrong where cells overlap\.$/).waitFor();
  const place = information.getByRole("button", { name: "cells 0 and 1" });
  const line = await place.evaluate((made) => made.closest("td").textContent);
  const at = line.slice("cells 0 and 1 at ".length).split(", ").map(Number);
  assert.ok(at[0] > 311000.1 && at[0] < 311002 && at[1] > 7479000.1 && at[1] < 7479002, line);
  // Values have room, and are not broken between letters.
  const narrow = await information.locator(".findings td").evaluateAll((cells) => cells.filter((cell) => cell.getBoundingClientRect().width < 100).map((cell) => cell.textContent));
  assert.deepEqual(narrow, []);
  await place.click();
  await at_rest(page);
  const { focal_point } = await page.evaluate(() => window.tessera.state().camera);
  assert.ok(Math.hypot(...focal_point.map((v, i) => v - at[i])) < 0.01, `${focal_point} for ${at}`);
  await information.getByText("311000, 7479000, 0").waitFor();
  no_errors();
});
