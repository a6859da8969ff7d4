// SPDX-License-Identifier: BSD-3-Clause
// Frames and the states that ask for them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { back_off, decoded_frame, median_and_95, StateSender } from "../../../server/web/frames.js";

function encoded(header, image, length) {
  const text = new TextEncoder().encode(JSON.stringify(header));
  const bytes = new Uint8Array(4 + text.length + image.length);
  new DataView(bytes.buffer).setUint32(0, length ?? text.length, true);
  bytes.set(text, 4);
  bytes.set(image, 4 + text.length);
  return bytes.buffer;
}

test("a frame is its header and its picture", () => {
  const { header, image } = decoded_frame(encoded({ type: "frame", number: 3, field: "ü" }, [1, 2, 3]));
  assert.equal(header.number, 3);
  assert.equal(header.field, "ü");
  assert.deepEqual([...image], [1, 2, 3]);
});

test("what is no frame is refused", () => {
  assert.throws(() => decoded_frame(new ArrayBuffer(2)), /cannot be read/);
  assert.throws(() => decoded_frame(encoded({}, [], 4000)), /cannot be read/);
  assert.throws(() => decoded_frame(encoded({}, [], 0xffffffff)), /cannot be read/);
});

function sender() {
  const sent = [];
  const clock = { now: 0 };
  const made = new StateSender((message) => sent.push(message), { patience: 1000, clock: () => clock.now });
  made.opened();
  return { made, sent, clock };
}

test("a burst of moving states leaves one in work, and the latest follows", () => {
  const { made, sent } = sender();
  for (let x = 0; x < 500; ++x) made.offer({ x }, true);
  assert.equal(sent.length, 1);
  made.answered(1);
  assert.deepEqual(sent.map((m) => m.state.x), [0, 499]);
  made.answered(2);
  assert.equal(sent.length, 2);
});

test("a state at rest is sent at once, and waits for nothing", () => {
  const { made, sent } = sender();
  made.offer({ x: 1 }, true);
  made.offer({ x: 2 }, false);
  assert.deepEqual(sent.map((m) => [m.number, m.moving]), [[1, true], [2, false]]);
});

test("an answer to an older state releases nothing", () => {
  const { made, sent } = sender();
  made.offer({ x: 1 }, true);
  made.offer({ x: 2 }, false);
  made.offer({ x: 3 }, true);
  made.answered(1);
  assert.equal(sent.length, 2);
  made.answered(2);
  assert.equal(sent.length, 3);
});

test("an answer that never comes is given up", () => {
  const { made, sent, clock } = sender();
  made.offer({ x: 1 }, true);
  made.offer({ x: 2 }, true);
  clock.now = 900;
  made.tick();
  assert.equal(sent.length, 1);
  clock.now = 1100;
  made.tick();
  assert.equal(sent.length, 2);
});

test("an answer that is on its way is waited for", () => {
  const { made, sent, clock } = sender();
  made.offer({ x: 1 }, true);
  made.offer({ x: 2 }, true);
  clock.now = 900;
  made.in_work();
  clock.now = 1800;
  made.tick();
  assert.equal(sent.length, 1);
});

test("a new connection is told the latest state, at rest, with a greater number", () => {
  const { made, sent } = sender();
  made.offer({ x: 1 }, true);
  made.closed();
  made.offer({ x: 2 }, true);
  assert.equal(sent.length, 1);
  made.opened();
  assert.deepEqual(sent[1], { type: "state", number: 2, moving: false, state: { x: 2 } });
});

test("tries of a connection come ever later, but not too late", () => {
  assert.equal(back_off(0, 0), 500);
  assert.equal(back_off(2, 0), 2000);
  assert.equal(back_off(50, 0), 15000);
  assert.ok(back_off(50, 1) <= 18750);
});

test("median and 95 %", () => {
  const { count, median, p95 } = median_and_95(Array.from({ length: 100 }, (_, i) => 100 - i));
  assert.deepEqual([count, median, p95], [100, 51, 96]);
});
