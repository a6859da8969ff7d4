// SPDX-License-Identifier: BSD-3-Clause
// What a server is started with is what the page's controls show, and what they can take away.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { write_flow_series, write_flow_with_inlet } from "./flow_series.mjs";
import { answered, at_rest, hang, launch, missing, run_command, serve, shown_bytes } from "./support.mjs";

const reason = missing();
if (reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), "tessera-start-"));
const with_inlet = write_flow_with_inlet(folder), series = write_flow_series(folder);
writeFileSync(join(folder, "flag.stl"), "solid flag\nfacet normal 0 -1 0\nouter loop\nvertex 0 -0.2 0\nvertex 1 -0.2 0\nvertex 0 -0.2 0.6\nendloop\nendfacet\nendsolid flag\n");
const grid = join(folder, "ripples.vti");
let browser, server, page;

/** A page of a server that was started with these words. */
async function begin(words) {
  await end();
  server = serve(words);
  const address = await server.address;
  page = await (await browser.newContext({ viewport: { width: 900, height: 640 } })).newPage();
  page.setDefaultTimeout(hang);
  page.errors = [];
  page.on("pageerror", (error) => page.errors.push(error.stack));
  await page.goto(address.href);
  await answered(page);
  await page.evaluate(() => document.querySelectorAll("details").forEach((section) => { section.open = true; }));
}

async function end() {
  if (!server) return;
  assert.deepEqual(page?.errors ?? [], []);
  await page?.context().close();
  server.child.kill("SIGKILL");
  await server.ended;
  server = undefined;
}

before(async () => {
  await run_command("tessera generate ripples ripples.vti n=16", folder);
  browser = await launch();
}, { timeout: hang });

after(async () => {
  await end();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const state = () => page.evaluate(() => window.tessera.state());
const full_state = () => page.evaluate(() => window.tessera.full_state());
const control = (name, kind = "input, select") => page.getByLabel(name, { exact: true }).and(page.locator(kind));
const texts = async (names) => Object.fromEntries(await Promise.all(names.map(async (name) => [name, await control(name, "input[type=text], input[type=color], select").inputValue()])));
const checks = async (names) => Object.fromEntries(await Promise.all(names.map(async (name) => [name, await control(name, "input[type=checkbox]").isChecked()])));

const every_option = ["--field", "pressure", "--time-step", "1", "--smooth", "--threshold=-0.9,0.9", "--clip", "box:0,0,0,1.5,1,1", "--clip", "1,0.5,0.5,0,1,0",
  "--transfer-function", "viridis:rise", "--range", "0.1,0.8", "--log", "--opacity", "2.5", "--unit-distance", "0.3", "--iso", "0.25:red:0.5", "--surface", "boundary:0.2,0.2,1:0.25",
  "--surface", `${join(folder, "flag.stl")}:tomato`, "--background", "navy", "--color-bar=left", "--color-bar-title", "p of {file}", "--color-bar-scale", "log", "--field-unit", "Pa",
  "--axes=both", "--outline", "--scale-bar=bottom", "--length-unit", "mm", "--annotation-size", "12", "--accuracy", "1e-3", "--view", "front", "--projection", "perspective"];

test("each option that the server was started with is in the panel", async () => {
  await begin([series, ...every_option]);
  assert.deepEqual(await texts(["Field", "Low end of the range", "High end of the range", "Overall opacity, a factor", "Unit distance", "Shape", "Bar's title", "Values, low end", "Values, high end", "x, high end",
    "Place of clip plane 1 along its direction", "Direction of clip plane 1", "Value of iso-surface 1", "Colour of iso-surface 1", "What surface 1 is", "Colour of surface 1", "What surface 2 is", "Colour of surface 2",
    "Axes", "Background", "Projection", "Accuracy"]), {
    Field: "pressure", "Low end of the range": "0.1", "High end of the range": "0.8", "Overall opacity, a factor": "2.5", "Unit distance": "0.3", Shape: "rise", "Bar's title": "p of {file}",
    "Values, low end": "-0.9", "Values, high end": "0.9", "x, high end": "1.5", "Place of clip plane 1 along its direction": "0.5", "Direction of clip plane 1": "2", "Value of iso-surface 1": "0.25",
    "Colour of iso-surface 1": "#ff0000", "What surface 1 is": "boundary", "Colour of surface 1": "#7c7cff", "What surface 2 is": join(folder, "flag.stl"), "Colour of surface 2": "#ff6347",
    Axes: "both", Background: "#000080", Projection: "perspective", Accuracy: "1e-3",
  });
  assert.deepEqual(await checks(["Log values", "Colour bar", "Threshold", "Clip by a box", "Outline", "Scale bar", "Smooth"]),
    { "Log values": true, "Colour bar": true, Threshold: true, "Clip by a box": true, Outline: true, "Scale bar": true, Smooth: true });
  assert.equal(await control("Time step", "input[type=text]").inputValue(), "1");
  assert.equal(await page.locator("[data-preset=viridis]").getAttribute("aria-pressed"), "true");
  const { position, focal_point } = (await full_state()).camera;
  assert.ok(position[1] < focal_point[1] && Math.abs(position[0] - focal_point[0]) < 1e-9, "it looks from the front");
  const described = { ...(await full_state()), camera: undefined, size: undefined };
  assert.deepEqual(described, { background: "navy", camera: undefined, size: undefined }, "the page need not repeat them");
});

test("what says how something is drawn goes and comes with it", async () => {
  const all = await shown_bytes(page);
  for (const [name, words] of [["Colour bar", ["color-bar", "color-bar-title", "color-bar-scale", "field-unit"]], ["Outline", ["outline"]], ["Scale bar", ["scale-bar"]]]) {
    await control(name, "input[type=checkbox]").uncheck();
    assert.ok(!(await shown_bytes(page)).equals(all), `${name} is still drawn`);
    const sent = await full_state();
    for (const word of words) assert.equal(sent[word], null, word);
    await control(name, "input[type=checkbox]").check();
    assert.ok((await shown_bytes(page)).equals(all), `${name} comes back another one`);
  }
  for (const name of ["Colour bar", "Outline", "Scale bar"]) await control(name, "input[type=checkbox]").uncheck();
  await control("Axes", "select").selectOption("none");
  await at_rest(page);
  assert.deepEqual([(await full_state())["length-unit"], (await full_state())["annotation-size"]], [null, null]);
  assert.equal(await page.locator(".message.error").count(), 0);
});

test("cuts and surfaces are removed, and the colours are edited", async () => {
  const removed = async (act, word) => {
    const before_it = await shown_bytes(page);
    await act();
    assert.ok(!(await shown_bytes(page)).equals(before_it), `${word} is still there`);
    return (await state())[word];
  };
  const press = (name) => () => page.getByRole("button", { name, exact: true }).click();
  assert.equal(await removed(press("Remove iso-surface 1"), "iso"), null);
  assert.deepEqual(await removed(press("Remove surface 1"), "surface"), [`${join(folder, "flag.stl")}:tomato`]);
  await page.getByLabel("Opacity of surface 1").fill("0.5");
  await at_rest(page);
  assert.deepEqual((await state()).surface, [`${join(folder, "flag.stl")}:tomato:0.5`]);
  assert.equal(await removed(press("Remove surface 1"), "surface"), null);
  assert.deepEqual(await removed(press("Remove clip plane 1"), "clip"), ["box:0,0,0,1.5,1,1"]);
  assert.equal(await removed(() => control("Clip by a box").uncheck(), "clip"), null);
  assert.equal(await removed(() => control("Threshold").uncheck(), "threshold"), null);
  assert.equal(await removed(() => control("Log values").uncheck(), "log"), null);
  await control("Smooth").uncheck();
  assert.equal((await state()).smooth, null, "which changes nothing of values at points");
  assert.match(await removed(() => page.locator("[data-preset=plasma]").click(), "transfer-function"), /^plasma:rise$/);
  await answered(page);
  const shown_points = () => page.evaluate(() => [...document.querySelectorAll(".opacity-handle")].map((point) => Number(point.getAttribute("aria-valuenow"))));
  const points = await shown_points();
  await page.locator(".opacity-handle").last().focus();
  await page.keyboard.press("ArrowDown");
  await answered(page);
  const after_key = await shown_points();
  assert.deepEqual(after_key.slice(0, -1).map((v) => v.toFixed(3)), points.slice(0, -1).map((v) => v.toFixed(3)), "the overall opacity is not counted twice");
  assert.equal((await texts(["Overall opacity, a factor"]))["Overall opacity, a factor"], "2.5");
  await control("Overall opacity, a factor", "input[type=text]").fill("1");
  await control("Overall opacity, a factor", "input[type=text]").press("Enter");
  await at_rest(page);
  assert.equal((await state()).opacity, null);
  await control("Unit distance", "input[type=text]").fill("0.7");
  await control("Unit distance", "input[type=text]").press("Enter");
  await answered(page);
  assert.equal((await texts(["Unit distance"]))["Unit distance"], "0.7");
});

test("another field goes without the values of the one that the server was started with", async () => {
  await begin([series, ...every_option]);
  await control("Field", "select").selectOption("region");
  await at_rest(page);
  const sent = await full_state();
  assert.deepEqual(["range", "threshold", "iso"].map((word) => sent[word]), [null, null, null]);
});

test("opacities that the server was started with give way to those that are edited or chosen", async () => {
  await begin([series, "--field", "pressure", "--transfer-function", "viridis", "--opacity-points", "0:0,0.5:0.5,1:0"]);
  assert.deepEqual(await page.evaluate(() => [...document.querySelectorAll(".opacity-handle")].map((point) => point.getAttribute("aria-valuenow"))), ["0", "0.5", "0"]);
  await page.locator(".opacity-handle").nth(1).focus();
  await page.keyboard.press("ArrowUp");
  await answered(page);
  assert.equal((await full_state())["opacity-points"], null);
  await page.keyboard.press("Control+z");
  await answered(page);
  await control("Shape", "select").selectOption("ends");
  await answered(page);
  assert.equal((await full_state())["opacity-points"], null);
  assert.equal((await texts(["Shape"])).Shape, "ends");
});

test("an iso-surface without a colour has the function's, and a threshold spans the whole field", async () => {
  await begin([series, "--field", "pressure", "--transfer-function", "viridis", "--iso", "0.25", "--threshold=-0.5,0.5"]);
  assert.match((await texts(["Colour of iso-surface 1"]))["Colour of iso-surface 1"], /^#(?!cccccc)[0-9a-f]{6}$/);
  const slid = Number(await control("Values, low end", "input[type=range]").inputValue());
  assert.ok(slid > 100 && slid < 500, `${slid} of 1000`);
});

for (const [word, lit] of [["--shade", true], ["--no-shade", false]])
  test(`light on a volume that the server was started with is switched: ${word}`, async () => {
    await begin([grid, word]);
    const shade = control("Shade the volume", "input[type=checkbox]");
    assert.equal(await shade.isChecked(), lit);
    const first = await shown_bytes(page);
    await shade.setChecked(!lit);
    assert.ok(!(await shown_bytes(page)).equals(first));
    await shade.setChecked(lit);
    assert.ok((await shown_bytes(page)).equals(first));
  });

test("blocks and surfaces that the file names are in the panel, and so is the background of a dark page", async () => {
  await begin([with_inlet, "--block", "fluid", "--surface", "inlet:gold:0.5", "--background", "0,0,0"]);
  assert.deepEqual(await texts(["What surface 1 is", "Colour of surface 1", "Background"]), { "What surface 1 is": "inlet", "Colour of surface 1": "#ffd700", Background: "#000000" });
  await page.emulateMedia({ colorScheme: "dark" });
  await at_rest(page);
  assert.equal((await full_state()).background, "0,0,0");
});
