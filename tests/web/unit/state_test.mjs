// SPDX-License-Identifier: BSD-3-Clause
// States, their history, and their way into an address.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fragment_of, link_of, state_of_fragment } from "../../../server/web/address.js";
import { StateHistory } from "../../../server/web/state.js";

test("undo and redo go through the states at rest", () => {
  const history = new StateHistory({ field: "p" });
  history.change({ field: "q" });
  history.change({ log: true });
  history.undo();
  assert.deepEqual(history.state, { field: "q" });
  history.undo();
  assert.deepEqual(history.state, { field: "p" });
  assert.ok(!history.can_undo);
  history.redo();
  history.redo();
  assert.deepEqual(history.state, { field: "q", log: true });
  assert.ok(!history.can_redo);
});

test("a drag is one step", () => {
  const history = new StateHistory({ x: 0 });
  for (let x = 1; x < 10; ++x) history.change({ x }, { moving: true });
  assert.ok(history.moving);
  history.settle();
  assert.ok(!history.moving);
  history.undo();
  assert.deepEqual(history.state, { x: 0 });
  assert.ok(!history.can_undo);
});

test("what follows the window is no step, and steps that held the same follow it", () => {
  const history = new StateHistory({ view: 1 });
  history.change({ log: true });
  history.change({ view: 2 });
  history.change({ log: undefined });
  history.adjust({ view: 3 });
  assert.deepEqual(history.state, { view: 3 });
  history.undo();
  assert.deepEqual(history.state, { view: 3, log: true });
  history.undo();
  assert.deepEqual(history.state, { view: 1, log: true });
  history.redo();
  assert.deepEqual(history.state, { view: 3, log: true });
});

test("undo in the middle of a drag goes back to before it", () => {
  const history = new StateHistory({ x: 0 });
  history.change({ x: 5 }, { moving: true });
  history.undo();
  assert.deepEqual(history.state, { x: 0 });
});

test("what moved and is cancelled goes back to where it rested, and is no step", () => {
  const history = new StateHistory({ x: 0 });
  history.change({ x: 1 });
  const heard = [];
  history.listen(({ state, moving, cause }) => heard.push([state.x, moving, cause]));
  history.cancel();
  history.change({ x: 5 }, { moving: true });
  history.cancel();
  assert.deepEqual(heard, [[5, true, "change"], [1, false, "cancel"]]);
  history.undo();
  assert.deepEqual(history.state, { x: 0 });
});

test("changes of one name at once are one step, later ones another", () => {
  let now = 0;
  const history = new StateHistory({ x: 0 }, () => now);
  history.change({ x: 1 }, { name: "wheel" });
  now = 100;
  history.change({ x: 2 }, { name: "wheel" });
  now = 5000;
  history.change({ x: 3 }, { name: "wheel" });
  history.undo();
  assert.deepEqual(history.state, { x: 2 });
  history.undo();
  assert.deepEqual(history.state, { x: 0 });
});

test("a change after undo ends redo, and one that changes nothing is no step", () => {
  const history = new StateHistory({ x: 0 });
  history.change({ x: 1 });
  history.undo();
  history.change({ x: 0 });
  assert.ok(history.can_redo);
  history.change({ x: 2 });
  assert.ok(!history.can_redo);
});

test("undefined and empty lists leave the state", () => {
  const history = new StateHistory({ range: "0,1" });
  history.change({ range: undefined, iso: [] });
  assert.deepEqual(history.state, {});
});

test("listeners hear what changed, whether it moves, and why", () => {
  const history = new StateHistory({ x: 0 });
  const heard = [];
  const end = history.listen((change) => heard.push([change.state.x, change.moving, change.cause]));
  history.change({ x: 1 }, { moving: true });
  history.settle();
  history.undo();
  history.load({ x: 9 });
  end();
  history.change({ x: 4 });
  assert.deepEqual(heard, [[1, true, "change"], [1, false, "change"], [0, false, "undo"], [9, false, "load"]]);
});

test("a state comes back from its fragment, whatever its letters", () => {
  const state = { field: "Druck «p»\u{1f30a}/+?", camera: { position: [1e-300, 0, 1 / 3], focal_point: [0, 0, 0], view_up: [0, 1, 0], parallel_scale: 2 }, clip: ["box:0,0,0,1,1,1"] };
  const fragment = fragment_of(state);
  assert.match(fragment, /^#1\.[\w-]+$/);
  assert.equal(JSON.stringify(state_of_fragment(fragment)), JSON.stringify(state));
  assert.equal(state_of_fragment(""), undefined);
  assert.equal(state_of_fragment("#"), undefined);
});

test("a damaged fragment is refused with a sentence", () => {
  const whole = fragment_of({ field: "pressure" });
  for (const damaged of [whole.slice(0, -4), "#1.!!!", "#2.e30", "#1.WzFd", "#elsewhere"])
    assert.throws(() => state_of_fragment(damaged), /damaged or cut short/);
});

test("a camera that is none is refused with a sentence", () => {
  const good = { position: [1, 2, 3], focal_point: [0, 0, 0], view_up: [0, 0, 1], view_angle: 30 };
  assert.deepEqual(state_of_fragment(fragment_of({ camera: good })), { camera: good });
  for (const camera of [null, 3, { ...good, position: [1, 2] }, { ...good, view_up: undefined }, { ...good, view_angle: "30" }, { ...good, parallel_scale: 1 }])
    assert.throws(() => state_of_fragment(fragment_of({ camera })), /damaged or cut short/);
});

test("a link never holds the token", () => {
  const link = link_of("http://127.0.0.1:8000/proxy/1/?token=secret&a=b#old", { x: 1 });
  assert.ok(!link.includes("secret"));
  assert.ok(link.startsWith("http://127.0.0.1:8000/proxy/1/?a=b#1."));
});
