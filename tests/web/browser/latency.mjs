// SPDX-License-Identifier: BSD-3-Clause
// How long from event to painted picture, as the page measures it: turns the view by the mouse for some seconds.
//
//   TESSERA_PROGRAM=... TESSERA_WEB_PACKAGES=... [TESSERA_RANKS=2] node latency.mjs FILE [SECONDS [WIDTHxHEIGHT [OPTIONS OF SERVE...]]]
import { at_rest, launch, missing, serve } from "./support.mjs";

const [file, seconds = "10", size = "1280x800", ...words] = process.argv.slice(2);
const reason = missing() || (file ? "" : "name a file");
if (reason) {
  console.error(`latency.mjs: ${reason}`);
  process.exit(2);
}
const [width, height] = size.split("x").map(Number);
const ranks = Number(process.env.TESSERA_RANKS ?? 1);
const server = serve([file, ...words], ranks);
const address = await server.address;
const browser = await launch();
const page = await browser.newPage({ viewport: { width, height } });
await page.goto(address.href);
const wait = 300000;
await page.waitForFunction(() => window.tessera?.shown(), null, { timeout: wait });
await page.waitForFunction(() => window.tessera.at_rest(), null, { timeout: wait });
const box = await page.locator("#picture").boundingBox();
await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
await page.mouse.down();
const begin = performance.now();
for (let i = 0; performance.now() - begin < 1000 * Number(seconds); ++i) {
  await page.mouse.move(box.x + box.width * (0.5 + 0.3 * Math.sin(i / 40)), box.y + box.height * (0.5 + 0.2 * Math.cos(i / 25)));
  await page.waitForTimeout(12);
}
const moving = await page.evaluate(() => ({
  ...window.tessera.latencies(), shown: window.tessera.shown(), of_data: window.tessera.latencies(false), of_preview: window.tessera.latencies(true),
}));
await page.mouse.up();
await at_rest(page).catch(() => {});
const still = await page.evaluate(() => window.tessera.shown());
console.log(JSON.stringify({
  file, ranks, window: size, frames: moving.count, frames_a_second: moving.count / Number(seconds), median_ms: moving.median, p95_ms: moving.p95,
  of_data: moving.of_data, of_preview: moving.of_preview,
  moving: { size: `${moving.shown.width}x${moving.shown.height}`, preview: moving.shown.preview, milliseconds: moving.shown.milliseconds },
  still: { level: still.level, size: `${still.width}x${still.height}`, milliseconds: still.milliseconds },
}, null, 1));
await browser.close();
server.child.kill("SIGTERM");
await server.ended;
