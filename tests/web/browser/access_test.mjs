// SPDX-License-Identifier: BSD-3-Clause
// Who may use a server from a browser, and what the page says where there is nothing to show.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import http from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { write_flow_series } from "./flow_series.mjs";
import { at_rest, hang, launch, make_rewriting_proxy, missing, serve } from "./support.mjs";

const reason = missing();
if (reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), "tessera-access-"));
write_flow_series(folder);
const file = join(folder, "flow_0.vtu");
let browser, server, address;
const started = [];

function start(words) {
  started.push(serve(words));
  return started.at(-1);
}

/** A page in a context of its own, or of `context`; what it throws is in `errors`. */
async function opened(href, context) {
  const page = await (context ?? (await browser.newContext({ viewport: { width: 900, height: 640 } }))).newPage();
  page.setDefaultTimeout(hang);
  page.errors = [];
  page.on("pageerror", (error) => page.errors.push(error.stack));
  await page.goto(href);
  return page;
}

before(async () => {
  server = start([file]);
  address = await server.address;
  browser = await launch();
}, { timeout: hang });

after(async () => {
  await browser?.close();
  for (const { child } of started) child.kill("SIGKILL");
  rmSync(folder, { recursive: true, force: true });
});

test("the token stays with the tab: no cookie, no address, and a reload finds it", async () => {
  const page = await opened(address.href);
  await at_rest(page);
  assert.deepEqual(await page.context().cookies(), []);
  assert.ok(!page.url().includes("token"), page.url());
  await page.reload();
  await at_rest(page);
  const second = await opened(address.href, page.context());
  await at_rest(second);
  await page.context().close();
});

test("no request but the page's own address has the token in its address", async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  page.setDefaultTimeout(hang);
  const asked = [], sockets = [];
  page.on("request", (request) => asked.push(request.url()));
  page.on("websocket", (socket) => sockets.push(socket.url()));
  await page.goto(address.href);
  await at_rest(page);
  assert.deepEqual(asked.filter((url) => url.includes("token=")), [address.href]);
  assert.equal(sockets.length, 1);
  assert.ok(!sockets[0].includes(address.searchParams.get("token")), sockets[0]);
  await context.close();
});

test("a page without the token asks for it, and takes an address that is typed", async () => {
  const page = await opened(address.origin);
  const banner = page.getByRole("alert").filter({ hasText: "does not have the server's token" });
  const field = banner.getByLabel("Address that tessera serve printed");
  await field.fill("nonsense");
  await field.press("Enter");
  await page.getByRole("alert").filter({ hasText: "neither an address with a token nor a token" }).waitFor();
  await field.fill(`${address.origin}/?token=${"0".repeat(32)}`);
  await banner.getByRole("button", { name: "Try again" }).click();
  const refused = page.getByRole("alert").filter({ hasText: "missing or belongs to another run" });
  await refused.getByLabel("Address that tessera serve printed").fill(address.href);
  await refused.getByRole("button", { name: "Try again" }).click();
  await at_rest(page);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a server that was started again at the same place is reached with its new address, and the view stays", async () => {
  const first = start([file]);
  const printed = await first.address;
  const page = await opened(printed.href);
  await at_rest(page);
  await page.evaluate(() => window.tessera.change({ outline: true }));
  await at_rest(page);
  first.child.kill("SIGTERM");
  await first.ended;
  const second = start([file, "--port", printed.port, "--axes"]);
  const renewed = await second.address;
  const refused = page.getByRole("alert").filter({ hasText: "missing or belongs to another run" });
  await refused.getByLabel("Address that tessera serve printed").fill(renewed.href);
  await refused.getByRole("button", { name: "Try again" }).click();
  await at_rest(page);
  assert.equal(await page.evaluate(() => window.tessera.state().outline), true);
  await page.waitForFunction(() => [...document.querySelectorAll("label")].find((label) => label.textContent === "Axes").control.value === "triad");
  await page.context().close();
});

test("a page of another local port has no picture made", async () => {
  const context = await browser.newContext();
  const page = await opened(address.href, context);
  await at_rest(page);
  const state = encodeURIComponent(JSON.stringify({ size: "8x8" }));
  const other = http.createServer((request, response) => response.setHeader("Content-Type", "text/html").end("<p>another server"));
  await new Promise((done) => other.listen(0, "127.0.0.1", done));
  try {
    const foreign = await opened(`http://127.0.0.1:${other.address().port}/`, context);
    const shown = (url) => foreign.evaluate((src) => new Promise((done) => {
      const image = new Image();
      image.onload = () => done(image.naturalWidth);
      image.onerror = () => done(0);
      image.src = src;
    }), url);
    assert.equal(await shown(`${address.origin}/picture?state=${state}`), 0);
    // Whoever is given the token may show pictures anywhere.
    assert.equal(await shown(`${address.origin}/picture?state=${state}&token=${address.searchParams.get("token")}`), 8);
  } finally {
    other.closeAllConnections();
    other.close();
  }
  await context.close();
});

test("behind a proxy that changes Host the page says what allows it", async () => {
  const proxy = await make_rewriting_proxy(Number(address.port));
  try {
    const page = await opened(`http://localhost:${proxy.port}/${address.search}`);
    const banner = page.getByRole("alert").filter({ hasText: "--allow-host localhost" });
    await banner.waitFor();
    assert.ok(await banner.getByRole("button", { name: "Try again" }).isVisible());
    assert.deepEqual(page.errors, []);
    await page.context().close();
  } finally {
    proxy.end();
  }
});

test("with that option it works behind the proxy, below a path", async () => {
  const allowing = start([file, "--allow-host", "localhost"]);
  const printed = await allowing.address;
  const proxy = await make_rewriting_proxy(Number(printed.port), "/p");
  try {
    const page = await opened(`http://localhost:${proxy.port}/p/${printed.search}`);
    await at_rest(page);
    await page.reload();
    await at_rest(page);
    await page.context().close();
    // Without the slash the page's own parts are asked for elsewhere: the page itself says so.
    const bare = await opened(`http://localhost:${proxy.port}/p${printed.search}`);
    await bare.getByText("the address must end with a slash").waitFor();
    assert.ok(await bare.getByText("--allow-host").isVisible());
    assert.ok((await bare.getByText("--allow-host").boundingBox()).y < 500, "it is seen at once");
    await bare.context().close();
  } finally {
    proxy.end();
  }
});

test("behind a proxy that asks for a password it works", async () => {
  const allowing = start([file, "--allow-host", "localhost"]);
  const printed = await allowing.address;
  const proxy = await make_rewriting_proxy(Number(printed.port), "", { password: "me:secret" });
  try {
    const page = await opened(`http://localhost:${proxy.port}/${printed.search}`, await browser.newContext({ httpCredentials: { username: "me", password: "secret" } }));
    await at_rest(page);
    await page.context().close();
  } finally {
    proxy.end();
  }
});

test("behind a proxy that passes no WebSocket on the page says so", async () => {
  const allowing = start([file, "--allow-host", "localhost"]);
  const printed = await allowing.address;
  const proxy = await make_rewriting_proxy(Number(printed.port), "", { upgrades: false });
  try {
    const page = await opened(`http://localhost:${proxy.port}/${printed.search}`);
    await page.getByRole("alert").filter({ hasText: "pass on the headers Upgrade and Connection" }).waitFor();
    assert.deepEqual(page.errors, []);
    await page.context().close();
  } finally {
    proxy.end();
  }
});

/** Presses all that can be seen of the page's controls, by mouse and by keys. */
async function press_everything(page) {
  const places = await page.evaluate(() => [...document.querySelectorAll("button, input, select, summary, [role=button]")].map((c) => c.getBoundingClientRect()).filter((box) => box.width > 0 && box.bottom < innerHeight)
    .map((box) => [box.x + box.width / 2, box.y + box.height / 2]));
  assert.ok(places.length > 20, `${places.length} controls`);
  for (const [x, y] of places) await page.mouse.click(x, y);
  for (const key of ["f", "r", "o", "p", "t", "l", "c", " ", ",", ".", "1", "7", "Control+z"]) await page.keyboard.press(key);
}

test("of a broken file the page says why, its controls are asleep, and it tries again once the file is whole", async () => {
  const broken = join(folder, "broken.vtu");
  writeFileSync(broken, "<VTKFile type='UnstructuredGrid'>");
  const page = await opened((await start([broken]).address).href);
  const alert = page.getByRole("alert").filter({ hasText: "broken.vtu" });
  await alert.waitFor();
  await press_everything(page);
  assert.deepEqual(page.errors, []);
  assert.deepEqual(await page.evaluate(() => ["panel", "view-tools", "status"].map((id) => document.getElementById(id).inert)), [true, true, true]);
  assert.ok(await page.locator("#axes").isHidden());
  assert.ok(await page.getByRole("button", { name: "Save the image" }).isDisabled());
  writeFileSync(broken, readFileSync(file));
  if (await page.getByRole("dialog").isVisible()) await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Try again" }).click();
  await at_rest(page);
  assert.equal(await alert.count(), 0);
  assert.equal(await page.locator("#panel").evaluate((panel) => panel.inert), false);
  await page.getByRole("button", { name: "Save the image" }).waitFor();
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("a field that the file has not leaves a page where others are chosen", async () => {
  const page = await opened((await start([file, "--field", "nothing", "--outline"]).address).href);
  await at_rest(page);
  await page.getByRole("alert").filter({ hasText: "nothing" }).filter({ hasText: "The image is made without that." }).waitFor();
  const field = page.getByLabel("Field", { exact: true });
  assert.equal(await field.inputValue(), "pressure");
  await field.selectOption("region");
  await at_rest(page);
  assert.equal((await page.evaluate(() => window.tessera.shown())).field, "region");
  await page.keyboard.press("Control+z");
  await at_rest(page);
  assert.equal((await page.evaluate(() => window.tessera.shown())).field, "pressure");
  assert.deepEqual(page.errors, []);
  await page.context().close();
});

test("so does a cut that leaves nothing", async () => {
  const page = await opened((await start([file, "--field", "pressure", "--threshold", "1e6,2e6", "--outline"]).address).href);
  await at_rest(page);
  await page.getByRole("alert").filter({ hasText: "The image is made without that." }).waitFor();
  assert.equal(await page.getByLabel("Threshold").isChecked(), false);
  assert.equal(await page.getByLabel("Outline").isChecked(), true);
  assert.deepEqual(page.errors, []);
  await page.context().close();
});
