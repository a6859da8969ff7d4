// SPDX-License-Identifier: BSD-3-Clause
// What the page says and offers to who does not know it: one server without ffmpeg, of a mesh with a surface beside it.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { write_flow_with_inlet } from "./flow_series.mjs";
import { at_rest, hang, launch, missing, serve, shown_bytes } from "./support.mjs";

const reason = missing();
if (reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), "tessera-guidance-"));
let browser, server, address, page;

before(async () => {
  const path = process.env.PATH;
  process.env.PATH = folder;
  server = serve([write_flow_with_inlet(folder), "--size", "320x240"]);
  process.env.PATH = path;
  address = await server.address;
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1000, height: 700 } })).newPage();
  page.setDefaultTimeout(hang);
  await page.goto(address.href);
  await at_rest(page);
}, { timeout: hang });

after(async () => {
  await browser?.close();
  server?.child.kill("SIGKILL");
  rmSync(folder, { recursive: true, force: true });
});

const state = () => page.evaluate(() => window.tessera.state());
const change = (keys) => page.evaluate((keys) => window.tessera.change(keys), keys);
const section = (title) => page.locator("details.section", { has: page.locator(`summary:text-is("${title}")`) });

test("the field stands at the panel's top", async () => {
  const [panel, field] = await Promise.all([page.locator("#panel").boundingBox(), page.getByLabel("Field", { exact: true }).boundingBox()]);
  assert.ok(field.y - panel.y < 40, `${field.y - panel.y} pixels below`);
});

test("the colours that the server chose are marked, and stay so while opacities are edited", async () => {
  const marked = () => page.evaluate(() => [...document.querySelectorAll("[data-preset][aria-pressed=true]")].map((c) => c.dataset.preset));
  assert.deepEqual(await marked(), ["cool-warm"]);
  await page.locator(".opacity-handle").nth(1).focus();
  await page.keyboard.press("ArrowUp");
  await at_rest(page);
  assert.deepEqual(await marked(), ["cool-warm"]);
  await page.getByRole("button", { name: "Reverse the colours" }).click();
  await at_rest(page);
  assert.deepEqual(await marked(), []);
});

test("the opacity's curve is drawn through its points", async () => {
  const [curve, points] = await page.evaluate(() => [document.querySelectorAll(".function-editor path.curve"), document.querySelectorAll(".opacity-handle")]
    .map((all) => [...all].map((one) => one.getBoundingClientRect().toJSON())));
  assert.equal(curve.length, 1);
  assert.ok(points.length > 2);
  const [first, last] = [points[0], points.at(-1)];
  assert.ok(curve[0].width > 0.9 * (last.x - first.x), `${curve[0].width} pixels wide between ${first.x} and ${last.x}`);
});

test("the custom shape is stated and cannot be chosen", async () => {
  assert.deepEqual(await page.evaluate(() => {
    const shape = document.querySelector("#shape");
    return [shape.value, shape.selectedOptions[0].textContent, shape.selectedOptions[0].disabled];
  }), ["", "custom", true]);
  await change({ "transfer-function": undefined, range: undefined });
  await at_rest(page);
});

test("of a logarithm it is said what becomes of values that have none", async () => {
  await page.getByLabel("Log values").check();
  await page.getByText(/^Values of 0 and below are treated as \S+, the smallest positive value found, for “Log values”\.$/).waitFor({ state: "visible" });
  await page.getByLabel("Log values").uncheck();
  await page.locator("#panel .warning", { hasText: "Values of 0 and below" }).waitFor({ state: "hidden" });
  await at_rest(page);
});

test("an iso-surface that the field does not reach is told", async () => {
  await change({ iso: ["99"] });
  await page.getByText(/^Nothing is seen at 99: the field goes from -?[0-9.]+ to [0-9.]+\.$/).waitFor({ state: "visible" });
  await change({ iso: ["0.5"] });
  await page.getByText("Nothing is seen at").waitFor({ state: "hidden" });
  await change({ iso: undefined });
  await at_rest(page);
});

test("surfaces that the file names are offered", async () => {
  const plain = await shown_bytes(page);
  await page.getByRole("button", { name: "Add a surface" }).click();
  const what = page.getByLabel("What surface 1 is");
  await what.waitFor();
  assert.deepEqual(await what.locator("option").allTextContents(), ["boundary", "inlet", "fluid"]);
  await what.selectOption("inlet");
  await at_rest(page);
  assert.match((await state()).surface[0], /^inlet:/);
  assert.ok(!(await shown_bytes(page)).equals(plain));
  await page.getByRole("button", { name: "Remove surface 1" }).click();
  assert.ok((await shown_bytes(page)).equals(plain));
});

test("errors and notes name the page's controls", async () => {
  await change({ threshold: "5,1" });
  const alert = page.getByRole("alert").filter({ hasText: "“Threshold”: the numbers of '5,1' are not in ascending order" });
  await alert.waitFor();
  await alert.getByRole("button", { name: "Undo" }).click();
  await at_rest(page);
  await section("Information").locator("summary").click();
  await section("Information").getByText("1 block is a surface and is left out: 'inlet' (“Surface” shows it)").waitFor();
});

test("without ffmpeg no films are offered, and it is said why", async () => {
  await section("Image and film").locator("summary").first().click();
  await page.getByText(/^No films are offered: films are made by the program ffmpeg.*apt install ffmpeg/).waitFor({ state: "visible" });
  assert.ok(await page.getByRole("button", { name: "Make film" }).isHidden());
});

test("a probe that is answered when the data have changed is not shown", async () => {
  await section("Probe").locator("summary").click();
  let release;
  const held = new Promise((done) => { release = done; });
  await page.route("**/api/probe", async (route) => {
    await held;
    await route.continue().catch(() => {});
  });
  const asked = page.waitForRequest("**/api/probe");
  const is_probe = (request) => request.url().endsWith("/api/probe");
  const over = Promise.any(["requestfailed", "requestfinished"].map((event) => page.waitForEvent(event, is_probe)));
  await page.getByRole("button", { name: "Probe the middle" }).click();
  await asked;
  await change({ threshold: "0,1e9" });
  release();
  await over;
  await at_rest(page);
  assert.equal(await section("Probe").locator("dl.facts dt").count(), 0);
  await page.unroute("**/api/probe");
  await change({ threshold: undefined });
  await at_rest(page);
});

test("a background that nobody chose goes with the page's theme", async () => {
  const ground = () => page.evaluate(() => window.tessera.full_state().background);
  const white = await ground(), light = await shown_bytes(page);
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForFunction((white) => window.tessera.full_state().background !== white, white);
  assert.ok(!(await shown_bytes(page)).equals(light));
  await change({ background: "#336699" });
  await page.emulateMedia({ colorScheme: "light" });
  await at_rest(page);
  assert.equal(await ground(), "#336699");
  await change({ background: undefined });
  assert.ok((await shown_bytes(page)).equals(light));
});

test("on a phone the list of keys begins at its top, and what is seen stays in the picture without the panel", async () => {
  await page.setViewportSize({ width: 400, height: 800 });
  await at_rest(page);
  await page.getByRole("button", { name: "Keyboard shortcuts (?)" }).click();
  assert.equal(await page.locator("#help").evaluate((dialog) => dialog.scrollTop), 0);
  assert.ok(await page.locator("#help").evaluate((dialog) => dialog.scrollHeight > dialog.clientHeight), "there is something to scroll");
  await page.getByRole("dialog").getByRole("button", { name: "Close" }).click();
  await page.locator("#picture").focus();
  for (const key of ["+", "f"]) {
    const before_key = JSON.stringify((await state()).camera);
    await page.keyboard.press(key);
    await page.waitForFunction((old) => JSON.stringify(window.tessera.state().camera) !== old, before_key);
    await at_rest(page);
  }
  /** Half of what is seen in the focal plane from left to right. */
  const half_width = () => page.evaluate(() => {
    const { camera } = window.tessera.state(), { width, height } = window.tessera.shown();
    return (camera.parallel_scale * width) / height;
  });
  const height = () => page.evaluate(() => window.tessera.shown().height);
  const [fitted, low] = [await half_width(), await height()];
  await page.getByRole("button", { name: "Settings" }).click();
  await page.waitForFunction((low) => window.tessera.at_rest() && window.tessera.shown().height > 1.5 * low, low);
  assert.ok(Math.abs((await half_width()) / fitted - 1) < 0.01, `${await half_width()} of ${fitted}`);
});
