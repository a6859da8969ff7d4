// SPDX-License-Identifier: BSD-3-Clause
// What is in the picture stays in it when its shape changes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { zoomed } from "../../../server/web/camera.js";
import { Framing } from "../../../server/web/framing.js";
import { StateHistory } from "../../../server/web/state.js";

const camera = { position: [0, 0, 5], focal_point: [0, 0, 0], view_up: [0, 1, 0], parallel_scale: 2 };

/** A page of this size. */
function framed(size) {
  const history = new StateHistory({ camera });
  const page = { history, view: { window_size: () => size, fixed: undefined }, get camera() { return history.state.camera; } };
  const framing = new Framing(page);
  framing.begin();
  return { page, framing, resize: (width, height) => {
    Object.assign(size, { width, height });
    framing.follow();
  } };
}

test("a narrower picture shows more from top to bottom, and its old shape the same again", () => {
  const { page, resize } = framed({ width: 400, height: 200 });
  resize(400, 600);
  assert.ok(Math.abs(page.camera.parallel_scale - 6) < 1e-12, "as much from left to right as before");
  assert.ok(!page.history.can_undo, "it is no step");
  resize(400, 200);
  assert.equal(page.camera, camera);
  resize(800, 200);
  assert.equal(page.camera, camera, "a wider one shows more at its sides");
});

test("a camera that is chosen in the new shape is kept", () => {
  const { page, resize } = framed({ width: 400, height: 200 });
  resize(200, 200);
  const own = zoomed(page.camera, 4);
  page.history.change({ camera: own });
  resize(400, 200);
  assert.equal(page.camera, own);
  page.history.undo();
  assert.deepEqual(page.camera.parallel_scale, 4);
});
