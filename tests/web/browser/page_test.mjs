// SPDX-License-Identifier: BSD-3-Clause
// The page in Chromium, with the server behind it: one browser, one server, one thing after another.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { chmodSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { write_flow_series } from "./flow_series.mjs";
import { answered, at_rest, hang, launch, make_proxy, missing, painted, run_command, serve, shown_bytes } from "./support.mjs";

const reason = missing();
if (reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), "tessera-page-"));
const file = write_flow_series(folder);
const window_size = { width: 900, height: 640 };
let browser, server, proxy, address, context, page;
const complaints = [];

/** A page of its own context that has opened the server's address once. */
async function open(path, options = {}) {
  const made = await browser.newContext({ viewport: window_size, acceptDownloads: true, ...options });
  made.setDefaultTimeout(hang);
  const opened = await made.newPage();
  opened.on("pageerror", (error) => complaints.push(error.stack));
  opened.on("console", (message) => {
    // A lost connection is told by the browser too.
    if (message.type() === "error" && !/ERR_|WebSocket|status of (4|503)/.test(message.text())) complaints.push(message.text());
  });
  await opened.goto(path);
  return opened;
}
const state = () => page.evaluate(() => window.tessera.state());
const section = (title) => page.locator("details.section", { has: page.locator(`summary:text-is("${title}")`) });
async function opened_section(title) {
  const found = section(title);
  if (!(await found.evaluate((made) => made.open))) await found.locator("summary").first().click();
  return found;
}

before(async () => {
  // A fake ffmpeg, which keeps the pictures as they come: a film then has known bytes.
  mkdirSync(join(folder, "bin"));
  writeFileSync(join(folder, "bin", "ffmpeg"), '#!/bin/sh\nfor last; do :; done\ncat > "$last"\n');
  chmodSync(join(folder, "bin", "ffmpeg"), 0o755);
  process.env.PATH = `${join(folder, "bin")}:${process.env.PATH}`;
  server = serve([file, "--size", "640x480"]);
  address = await server.address;
  proxy = await make_proxy(Number(address.port));
  address.port = String(proxy.port);
  browser = await launch();
  page = await open(address.href, { permissions: ["clipboard-read", "clipboard-write"] });
  context = page.context();
}, { timeout: hang });

after(async () => {
  await browser?.close();
  proxy?.end();
  server?.child.kill("SIGKILL");
  rmSync(folder, { recursive: true, force: true });
});

let first;

test("the page opens and shows the exact picture, and the address keeps no token", async () => {
  first = await shown_bytes(page);
  const header = await page.evaluate(() => window.tessera.shown());
  assert.equal(header.level, "exact");
  assert.equal(header.mime, "image/png");
  const box = await page.locator("#picture").boundingBox();
  assert.deepEqual([header.width, header.height], [Math.round(box.width), Math.round(box.height)]);
  await page.waitForFunction(() => location.hash.length > 4);
  assert.ok(!page.url().includes("token"), page.url());
  assert.equal(await page.locator("#file").textContent(), "flow.pvd");
});

test("the canvas has the picture's own pixels", async () => {
  const [shown, decoded] = await page.evaluate(async () => {
    const canvas = document.querySelector("#canvas");
    const bitmap = await createImageBitmap(new Blob([window.tessera.bytes()], { type: "image/png" }));
    const other = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    other.drawImage(bitmap, 0, 0);
    const pixels = (context, { width, height }) => Array.from(context.getImageData(0, 0, width, height).data);
    const sums = [pixels(canvas.getContext("2d"), canvas), pixels(other, bitmap)];
    return sums.map((list) => list.reduce((sum, v, i) => (sum + v * ((i % 9973) + 1)) % 1e9, 0));
  });
  assert.equal(shown, decoded);
});

test("a mouse turns the view; the moving pictures are followed by the exact one", async () => {
  const before_turn = await state();
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  for (let i = 1; i <= 20; ++i) {
    await page.mouse.move(box.x + box.width / 2 + 6 * i, box.y + box.height / 2 + 2 * i);
  }
  await page.waitForFunction(() => window.tessera.shown().level === "moving");
  await page.mouse.up();
  const turned = await shown_bytes(page);
  assert.notDeepEqual((await state()).camera, before_turn.camera);
  assert.ok(!turned.equals(first));
  const { count } = await page.evaluate(() => window.tessera.latencies());
  assert.ok(count > 0);
});

test("undo brings the same bits back, and redo the others", async () => {
  const turned = await shown_bytes(page);
  await page.keyboard.press("Control+z");
  assert.ok((await shown_bytes(page)).equals(first));
  await page.keyboard.press("Control+Shift+z");
  assert.ok((await shown_bytes(page)).equals(turned));
});

test("the view is turned, moved and zoomed by keys alone", async () => {
  await page.locator("#picture").focus();
  for (const key of ["ArrowRight", "Shift+ArrowUp", "+", "]"]) {
    const before_key = JSON.stringify((await state()).camera);
    await page.keyboard.press(key);
    await page.waitForFunction((old) => JSON.stringify(window.tessera.state().camera) !== old, before_key);
  }
  await at_rest(page);
  await page.keyboard.press("t");
  await page.keyboard.press("t");
  await page.waitForFunction(() => window.tessera.state().camera.view_angle > 0);
  const position = (await state()).camera.position;
  await page.keyboard.down("w");
  await page.waitForFunction((old) => JSON.stringify(window.tessera.state().camera.position) !== old, JSON.stringify(position));
  await page.keyboard.up("w");
  await at_rest(page);
  await page.keyboard.press("t");
});

test("a wheel zooms to the cursor, and a burst of events leaves few states", async () => {
  const sent = await page.evaluate(() => window.tessera.sent());
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.evaluate(() => {
    const picture = document.querySelector("#picture");
    for (let i = 0; i < 500; ++i) picture.dispatchEvent(new WheelEvent("wheel", { deltaY: i % 2 ? -6 : 5, clientX: 200, clientY: 200, cancelable: true }));
  });
  await at_rest(page);
  const burst = (await page.evaluate(() => window.tessera.sent())) - sent;
  assert.ok(burst >= 2 && burst <= 20, `${burst} states were sent`);
});

test("fingers pinch to zoom", async () => {
  const before_pinch = (await state()).camera;
  await page.evaluate(() => {
    const picture = document.querySelector("#picture");
    picture.setPointerCapture = () => {};
    const fire = (type, id, x, y) => picture.dispatchEvent(new PointerEvent(type, { pointerId: id, pointerType: "touch", clientX: x, clientY: y, bubbles: true, isPrimary: id === 11, button: 0 }));
    fire("pointerdown", 11, 300, 300);
    fire("pointerdown", 12, 360, 300);
    for (let i = 1; i < 10; ++i) {
      fire("pointermove", 11, 300 - 8 * i, 300);
      fire("pointermove", 12, 360 + 8 * i, 300);
    }
    fire("pointerup", 11, 228, 300);
    fire("pointerup", 12, 432, 300);
    delete picture.setPointerCapture;
  });
  await at_rest(page);
  const { camera } = await state();
  const size = (c) => c.parallel_scale ?? Math.hypot(...c.position.map((v, i) => v - c.focal_point[i]));
  assert.ok(size(camera) < 0.6 * size(before_pinch), `${size(camera)} of ${size(before_pinch)}`);
});

test("named views come from the server", async () => {
  await page.keyboard.press("1");
  await page.waitForFunction(() => window.tessera.state().camera.view_up[2] === 1);
  await at_rest(page);
  const { camera } = await state();
  assert.ok(Math.abs(camera.position[0] - camera.focal_point[0]) < 1e-9 && camera.position[1] < camera.focal_point[1]);
});

test("an end of the axes is a button that looks from there", async () => {
  await page.locator("#axes .axis-end", { hasText: "Look from +x" }).last().click();
  await page.waitForFunction(() => {
    const { position, focal_point } = window.tessera.state().camera;
    return position[0] - focal_point[0] > 1 && Math.abs(position[1] - focal_point[1]) < 1e-9;
  });
  await page.locator("#axes .axis-end").filter({ hasText: "Look from -y" }).focus();
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => Math.abs(window.tessera.state().camera.position[0] - window.tessera.state().camera.focal_point[0]) < 1e-9);
  await at_rest(page);
});

test("a double click centres what is there", async () => {
  const box = await page.locator("#picture").boundingBox();
  const before_click = (await state()).camera.focal_point;
  await page.mouse.dblclick(box.x + 0.45 * box.width, box.y + 0.55 * box.height);
  await page.waitForFunction((old) => JSON.stringify(window.tessera.state().camera.focal_point) !== JSON.stringify(old), before_click);
  await at_rest(page);
});

test("the keys are listed", async () => {
  await page.locator("#picture").focus();
  await page.keyboard.press("?");
  await page.getByRole("dialog").getByText("Keys anywhere").waitFor();
  await page.keyboard.press("Escape");
  await page.getByRole("dialog").waitFor({ state: "hidden" });
});

test("points of the function are added, dragged, typed and removed", async () => {
  const editor = page.locator(".function-editor");
  await page.waitForSelector(".opacity-handle");
  const before_edit = await shown_bytes(page);
  const box = await editor.boundingBox();
  const count = await page.locator(".opacity-handle").count();
  await page.mouse.dblclick(box.x + 0.55 * box.width, box.y + 0.35 * box.height);
  await page.waitForFunction((n) => document.querySelectorAll(".opacity-handle").length === n + 1, count);
  await at_rest(page);
  const points = () => page.evaluate(() => window.tessera.state()["transfer-function"].Points);
  assert.equal((await points()).length, 4 * (count + 1));
  assert.ok(!(await shown_bytes(page)).equals(before_edit));

  const dot = await page.locator(".opacity-handle.selected").boundingBox();
  await page.mouse.move(dot.x + dot.width / 2, dot.y + dot.height / 2);
  await page.mouse.down();
  await page.mouse.move(dot.x + dot.width / 2 + 20, dot.y + dot.height / 2 + 40, { steps: 6 });
  await page.mouse.up();
  await at_rest(page);
  const opacity = page.getByLabel("Opacity of the point, per unit distance");
  await opacity.fill("0.0125");
  await opacity.press("Enter");
  await at_rest(page);
  assert.ok((await points()).includes(0.0125));
  await page.locator(".opacity-handle.selected").focus();
  await page.keyboard.press("Delete");
  await page.waitForFunction((n) => document.querySelectorAll(".opacity-handle").length === n, count);
  await at_rest(page);
});

test("an edited function survives the way to the server and back", async () => {
  const before_reply = await page.evaluate(() => window.tessera.state()["transfer-function"]);
  await page.locator(".opacity-handle").first().focus();
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowDown");
  await answered(page);
  const after_reply = await page.evaluate(() => window.tessera.state()["transfer-function"]);
  assert.deepEqual(after_reply.RGBPoints, before_reply.RGBPoints);
  assert.equal(after_reply.Points.length, before_reply.Points.length);
});

test("presets, logarithm and range", async () => {
  await page.locator('[data-preset="viridis"]').click();
  await page.waitForFunction(() => document.querySelector('[data-preset="viridis"]').getAttribute("aria-pressed") === "true");
  await at_rest(page);
  const colors = await page.evaluate(() => window.tessera.state()["transfer-function"]);
  assert.ok(typeof colors === "string" || colors.Name === "viridis");
  const low = page.getByLabel("Low end of the range").and(page.locator("input"));
  await low.fill("0.25");
  await low.press("Enter");
  await at_rest(page);
  assert.match((await state()).range, /^0\.25,/);
  await low.press("Control+z");
  await at_rest(page);
  assert.doesNotMatch((await state()).range ?? "", /^0\.25,/);
  assert.notEqual(await low.inputValue(), "0.25");
  await low.press("Control+Shift+z");
  await at_rest(page);
  await low.fill("nonsense");
  await low.press("Enter");
  assert.equal(await low.getAttribute("aria-invalid"), "true");
  assert.match((await state()).range, /^0\.25,/);
  await low.fill("0.25");
  await low.press("Enter");
  await page.getByRole("button", { name: "In view", exact: true }).click();
  await page.waitForFunction(() => !window.tessera.state().range.startsWith("0.25,"));
  await at_rest(page);
  await page.getByLabel("Log values").check();
  await at_rest(page);
  assert.equal((await state()).log, true);
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await at_rest(page);
  assert.equal((await state()).log, undefined);
});

test("a colour map of ParaView's is imported, and exported again", async () => {
  const map = [{ Name: "two", ColorSpace: "RGB", RGBPoints: [-1, 0, 0, 1, 2, 1, 0, 0], Points: [-1, 0, 0.5, 0, 2, 0.6, 0.5, 0] }];
  await page.locator('input[type="file"]').setInputFiles({ name: "map.json", mimeType: "application/json", buffer: Buffer.from(JSON.stringify(map)) });
  await page.waitForFunction((first) => window.tessera.state()["transfer-function"]?.RGBPoints?.[0] === first, map[0].RGBPoints[0]);
  assert.deepEqual((await state())["transfer-function"].RGBPoints, map[0].RGBPoints);
  await answered(page);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Export" }).click()]);
  const exported = JSON.parse(readFileSync(await download.path(), "utf8"));
  const got = Array.isArray(exported) ? exported[0] : exported;
  assert.ok(Math.abs(got.RGBPoints[0] + 1) < 1e-9);
  await page.locator('input[type="file"]').setInputFiles({ name: "x.json", mimeType: "application/json", buffer: Buffer.from("{}") });
  await page.getByRole("alert").filter({ hasText: "no RGBPoints" }).waitFor();
  await page.getByRole("alert").filter({ hasText: "no RGBPoints" }).getByRole("button", { name: "Dismiss" }).click();
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await at_rest(page);
});

test("field, component and time step change the picture", async () => {
  const data = await opened_section("Data");
  const before_field = await shown_bytes(page);
  const field = page.locator(".panel-top");
  await field.getByLabel("Field").selectOption("velocity");
  await at_rest(page);
  assert.equal((await state()).field, "velocity:mag");
  await field.getByLabel("Component").selectOption("y");
  await at_rest(page);
  assert.equal((await page.evaluate(() => window.tessera.shown())).field, "velocity:y");
  await field.getByLabel("Field").selectOption("region");
  await at_rest(page);
  await field.getByLabel("Field").selectOption("pressure");
  await at_rest(page);
  const step = data.getByLabel("Time step").and(page.locator("input[type=text]"));
  const old_step = await step.inputValue();
  await step.fill(old_step === "1" ? "2" : "1");
  await step.press("Enter");
  assert.ok(!(await shown_bytes(page)).equals(before_field));
});

test("time steps are played", async () => {
  await page.locator("#picture").focus();
  await page.keyboard.press("Space");
  await page.waitForFunction(() => {
    const steps = (window.steps_played ??= new Set());
    return steps.add(window.tessera.state()["time-step"]).size === 3;
  });
  await page.keyboard.press("Space");
  await at_rest(page);
});

test("threshold, box, plane and iso-surface", async () => {
  const data = await opened_section("Data");
  await data.getByLabel("Threshold").check();
  await at_rest(page);
  assert.match((await state()).threshold, /,/);
  await data.getByLabel("Threshold").uncheck();
  await data.getByLabel("Clip by a box").check();
  const high = data.getByLabel("x, high end").and(page.locator("input[type=text]"));
  await high.fill("1.25");
  await high.press("Enter");
  await at_rest(page);
  assert.deepEqual((await state()).clip, ["box:0,0,0,1.25,1,1"]);
  await data.getByRole("button", { name: "Add a clip plane" }).click();
  await at_rest(page);
  assert.equal((await state()).clip.length, 2);
  assert.equal(await data.getByLabel("x, high end").and(page.locator("input[type=range]")).inputValue(), "625", "the slider spans what is cut away too");
  await data.getByRole("button", { name: "Add an iso-surface" }).click();
  await data.getByRole("button", { name: "Add a surface" }).click();
  await at_rest(page);
  assert.equal((await state()).iso.length, 1);
  assert.match((await state()).surface[0], /^boundary:#/);
});

test("the picture is saved, and is what the copied command makes", async () => {
  await page.evaluate(() => window.tessera.change({ outline: true, axes: "both", "scale-bar": true, "color-bar": true }));
  await at_rest(page);
  const box = await opened_section("Image and film");
  await box.getByLabel("Width, pixels").fill("333");
  await box.getByLabel("Height, pixels").fill("222");
  const [download] = await Promise.all([page.waitForEvent("download"), box.getByRole("button", { name: "Save", exact: true }).click()]);
  const saved = readFileSync(await download.path());
  await page.getByText(`Saved picture.png: 333 × 222 pixels, ${Number((saved.length / 1000).toPrecision(3))} kB.`).first().waitFor();
  await box.getByLabel("Show at this size").check();
  await at_rest(page);
  await box.getByRole("button", { name: "Copy command" }).click();
  await page.waitForFunction(() => window.tessera.copied()?.startsWith("tessera render"));
  const command = await page.evaluate(() => navigator.clipboard.readText());
  await run_command(command, folder);
  assert.ok(readFileSync(join(folder, "picture.png")).equals(saved), command);
  await run_command(`${command} --integrator exact`, folder);
  assert.ok(readFileSync(join(folder, "picture.png")).equals(await shown_bytes(page)), "the exact frame is the exact picture");
  const [exr] = await Promise.all([page.waitForEvent("download"), (async () => {
    await box.getByLabel("Format").selectOption("exr");
    await box.getByRole("button", { name: "Save", exact: true }).click();
  })()]);
  assert.equal(readFileSync(await exr.path()).readUInt32LE(0), 20000630);
});

test("films are full orbits, or go along key views", async () => {
  const box = await opened_section("Image and film");
  await box.getByLabel("Width, pixels").fill("48");
  await box.getByLabel("Height, pixels").fill("32");
  await box.getByLabel("Frames", { exact: true }).fill("5");
  const made = async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), box.getByRole("button", { name: "Make film" }).click()]);
    assert.match(download.suggestedFilename(), /\.mp4$/);
    const bytes = readFileSync(await download.path());
    await page.getByText("Saved film.mp4: 5 frames, 23 kB.").first().waitFor();
    assert.equal(bytes.length, 5 * 48 * 32 * 3);
    return [0, 1, 2, 3, 4].map((n) => bytes.subarray(n * 48 * 32 * 3, (n + 1) * 48 * 32 * 3));
  };
  const orbit = await made();
  for (let n = 1; n < 5; ++n) assert.ok(!orbit[n].equals(orbit[n - 1]), `frame ${n} of the orbit is the one before`);
  await box.getByLabel("Path").selectOption("views");
  await box.getByRole("button", { name: "Make film" }).click();
  await page.getByText("A film along key views needs two of them").waitFor();
  await box.getByRole("button", { name: "Add this view" }).click();
  await page.locator("#picture").focus();
  await page.keyboard.press("ArrowRight");
  await at_rest(page);
  await box.getByRole("button", { name: "Add this view" }).click();
  const along = await made();
  assert.ok(!along[4].equals(along[0]), "the film ends where it began");
  assert.ok(!along[2].equals(along[0]) && !along[2].equals(along[4]), "there is nothing between the key views");
});

test("a link opened by another browser gives the same bits", async () => {
  const own = await shown_bytes(page);
  await page.locator("#picture").focus();
  await page.keyboard.press("l");
  await page.waitForFunction(() => window.tessera.copied()?.startsWith("http"));
  const link = new URL(await page.evaluate(() => window.tessera.copied()));
  assert.ok(!link.search.includes("token"));
  link.searchParams.set("token", address.searchParams.get("token"));
  const other = await open(link.href, { viewport: { width: 500, height: 800 }, colorScheme: "dark" });
  assert.ok((await shown_bytes(other)).equals(own));
  await other.context().close();
});

test("the picture follows the window again", async () => {
  await page.locator("#fixed-size button").click();
  for (const width of [820, 1500, 420]) {
    await page.setViewportSize({ width, height: 500 });
    await page.waitForFunction(() => {
      const box = document.querySelector("#picture").getBoundingClientRect(), shown = window.tessera.shown();
      return window.tessera.at_rest() && shown.width === Math.round(box.width) && shown.height === Math.round(box.height);
    });
    const sent = await page.evaluate(() => window.tessera.sent());
    await answered(page);
    await painted(page);
    assert.equal(await page.evaluate(() => window.tessera.sent()), sent, "a picture at rest stays at rest");
  }
  await page.setViewportSize(window_size);
  await at_rest(page);
});

test("a probe tells the value and draws the profile", async () => {
  await page.evaluate(() => window.tessera.change({ iso: undefined, surface: undefined, clip: undefined }));
  await page.locator("#picture").focus();
  await page.keyboard.press("f");
  await at_rest(page);
  const probe = await opened_section("Probe");
  await probe.getByRole("button", { name: "Probe the middle" }).click();
  await probe.getByText("Value", { exact: true }).waitFor();
  assert.ok((await probe.locator(".profile path.value").getAttribute("d")).length > 100);
  await page.locator("#marker").waitFor({ state: "visible" });
});

test("what was found goes when the data change, and what cannot be used is said", async () => {
  assert.match(await page.locator("#marker").getAttribute("data-value"), /^-?[0-9]/);
  await page.evaluate(() => window.tessera.change({ threshold: "0,1e9" }));
  await page.locator("#marker").waitFor({ state: "hidden" });
  await page.evaluate(() => window.tessera.change({ threshold: undefined }));
  await at_rest(page);
  const panel = await opened_section("Colour and opacity");
  const low = panel.locator("input[aria-label='Low end of the range']");
  const held = await low.inputValue();
  await low.fill("abc");
  await low.press("Enter");
  await page.getByText(`"abc" cannot be used here; ${held} is kept`).first().waitFor();
  await page.evaluate(() => document.activeElement.blur());
  for (const name of ["rise", "ramp"]) {
    await panel.locator("#shape").selectOption(name);
    await at_rest(page);
    await page.waitForFunction((wanted) => !document.querySelector(".curve-row").inert && document.querySelector("#shape").value === wanted, name);
  }
});

test("pixels are verified on request", async () => {
  await page.getByRole("button", { name: "Verify" }).click();
  await page.locator(".verdict[data-good='true']").waitFor();
  assert.match(await page.locator(".verdict").textContent(), /1000 pixels/);
});

test("the mesh is checked on request", async () => {
  const information = await opened_section("Information");
  await information.getByRole("button", { name: "Check the mesh" }).click();
  await information.getByText(/^The mesh is sound/).waitFor();
  assert.ok((await information.locator(".findings tr").count()) > 5);
});

test("an error is a sentence on the page, and undo mends it", async () => {
  const good = await shown_bytes(page);
  await page.evaluate(() => window.tessera.change({ threshold: "5,1" }));
  const alert = page.getByRole("alert").filter({ hasText: "threshold" });
  await alert.waitFor();
  await alert.getByRole("button", { name: "Undo" }).click();
  assert.ok((await shown_bytes(page)).equals(good));
  assert.equal(await page.getByRole("alert").filter({ hasText: "threshold" }).count(), 0);
});

test("a damaged link is told, and the page works", async () => {
  const other = await open(`${address.href}#1.broken`);
  await other.getByRole("alert").filter({ hasText: "damaged or cut short" }).waitFor();
  await at_rest(other);
  await other.context().close();
});

test("a link with an option that there is none of is told, and the default view mends it", async () => {
  const fragment = Buffer.from(JSON.stringify({ nonsense: 1 })).toString("base64url");
  const other = await open(`${address.href}#1.${fragment}`);
  const alert = other.getByRole("alert").filter({ hasText: "nonsense" });
  await alert.getByRole("button", { name: "Default view" }).click();
  await at_rest(other);
  await alert.waitFor({ state: "detached" });
  await other.context().close();
});

test("all controls have names, and text can be read on its ground", async () => {
  for (const title of ["Colour and opacity", "Data", "View", "Image and film", "Probe", "Information"]) await opened_section(title);
  for (const scheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme: scheme });
    const bad = await page.evaluate(() => {
      const nameless = [...document.querySelectorAll("button, input:not([type=file]), select, [role=slider], [role=button]")].filter((c) =>
        !(c.getAttribute("aria-label") || c.textContent.trim() || c.labels?.[0]?.textContent.trim() || c.getAttribute("aria-labelledby")));
      const luminance = (color) => {
        const [r, g, b] = color.match(/[\d.]+/g).map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const panel = luminance(getComputedStyle(document.querySelector("#panel")).backgroundColor);
      const faint = [...document.querySelectorAll("#panel label, #panel summary, #panel .hint, #panel dt, #panel button:not(:disabled):not(.primary)")].filter((c) => {
        const [low, high] = [panel, luminance(getComputedStyle(c).color)].sort((a, b) => a - b);
        return (high + 0.05) / (low + 0.05) < 4.5;
      });
      // A field's own ground, and no part of it let through.
      const faint_hints = [...document.querySelectorAll("#panel input[placeholder]")].filter((c) => {
        const hint = getComputedStyle(c, "::placeholder");
        const [low, high] = [getComputedStyle(c).backgroundColor, hint.color].map(luminance).sort((a, b) => a - b);
        return (high + 0.05) / (low + 0.05) < 4.5 || Number(hint.opacity) * Number(getComputedStyle(c).opacity) < 1;
      });
      return [...nameless, ...faint, ...faint_hints].map((c) => c.outerHTML.slice(0, 120));
    });
    assert.deepEqual(bad, [], scheme);
  }
  await page.emulateMedia({ colorScheme: null });
});

test("nothing is wider than its place, in any window", async () => {
  for (const [width, height] of [[400, 700], [1280, 800], [4000, 2200]]) {
    await page.setViewportSize({ width, height });
    await painted(page);
    const wide = await page.evaluate(() => {
      const right = document.querySelector("#panel").getBoundingClientRect().right;
      return [...document.querySelectorAll("header, main, #panel *, #status")].filter((c) => c.getBoundingClientRect().right > right + 1 && !c.closest("svg")).map((c) => c.outerHTML.slice(0, 100));
    });
    assert.deepEqual(wide, [], `${width} wide`);
  }
  await page.setViewportSize(window_size);
  await at_rest(page);
});

test("a lost connection comes back by itself to the same state", async () => {
  const own = await shown_bytes(page);
  const kept = await state();
  proxy.cut();
  await page.getByRole("alert").filter({ hasText: "connection to the server is lost" }).waitFor();
  await page.evaluate(() => window.tessera.change({ outline: null }));
  proxy.mend();
  await page.waitForFunction(() => document.body.dataset.connection === "open");
  await page.locator("#banner").waitFor({ state: "hidden" });
  assert.ok(!(await shown_bytes(page)).equals(own));
  await page.evaluate((outline) => window.tessera.change({ outline }), kept.outline);
  assert.ok((await shown_bytes(page)).equals(own));
});

test("a connection that nothing comes through any more is noticed, and made anew", async () => {
  await page.evaluate(() => Object.assign(window.tessera.connection, { silence: 500, answer_time: 500 }));
  await at_rest(page);
  proxy.freeze();
  await page.evaluate(() => window.tessera.change({ log: true }));
  await page.getByRole("alert").filter({ hasText: "connection to the server is lost" }).waitFor();
  proxy.mend();
  await page.waitForFunction(() => document.body.dataset.connection === "open");
  await at_rest(page);
  await page.evaluate(() => Object.assign(window.tessera.connection, { silence: 20000, answer_time: 10000 }));
  await page.evaluate(() => window.tessera.change({ log: undefined }));
  await at_rest(page);
});

test("the page works over https", { skip: process.env.TESSERA_WITHOUT_TLS === "1" && "built without TLS" }, async () => {
  const [certificate, key] = ["own.pem", "own-key.pem"].map((name) => join(folder, name));
  execFileSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", certificate, "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1"], { stdio: "ignore" });
  const other = serve([file, "--size", "64x48", "--tls-certificate", certificate, "--tls-key", key]);
  try {
    const link = await other.address;
    assert.equal(link.protocol, "https:");
    const secure = await open(link.href, { ignoreHTTPSErrors: true });
    await at_rest(secure);
    assert.ok((await shown_bytes(secure)).length > 1000);
    assert.ok(await secure.evaluate(() => window.isSecureContext));
    await secure.context().close();
  } finally {
    other.child.kill("SIGTERM");
  }
  assert.equal(await other.ended, 0);
});

test("a server that ends says so, and ends well", async () => {
  server.child.kill("SIGTERM");
  await page.getByRole("alert").filter({ hasText: "The server has ended" }).waitFor();
  assert.equal(await server.ended, 0);
});

test("the page has complained of nothing", () => {
  assert.deepEqual(complaints, []);
  assert.equal(context.pages().length, 1);
});
