// SPDX-License-Identifier: BSD-3-Clause
// Which handle a press takes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { nearest_handle } from "../../../server/web/handles.js";

const points = [{ name: "opacity-0", x: 100, y: 50, reach: 13 }, { name: "opacity-1", x: 106, y: 50, reach: 13 }, { name: "opacity-2", x: 106, y: 120, reach: 13 }];
const taken = (x, y, handles = points, selected) => nearest_handle(handles, { x, y }, selected)?.name;

test("of two points that overlap a press takes the nearer one, whichever was drawn last", () => {
  assert.equal(taken(100, 50), "opacity-0");
  assert.equal(taken(102, 52), "opacity-0");
  assert.equal(taken(104, 50), "opacity-1");
  assert.equal(taken(106, 50, [...points].reverse()), "opacity-1");
});

test("nothing is taken from beyond its reach", () => {
  assert.equal(taken(80, 50), undefined);
  assert.equal(taken(106, 85), undefined);
  assert.equal(taken(0, 0, []), undefined);
});

test("where two are as near, the one that is selected is taken", () => {
  const pair = [{ name: "a", x: 10, y: 10, reach: 13 }, { name: "b", x: 10, y: 10, reach: 13 }];
  assert.equal(taken(11, 10, pair), "a");
  assert.equal(taken(11, 10, pair, "b"), "b");
  assert.equal(taken(11, 10, pair, "c"), "a");
});

test("a line is taken along all of it, but after the points on it", () => {
  const line = { name: "range-0", x: 100, y: 10, foot: 200, reach: 4, behind: 6 };
  assert.equal(taken(101, 160, [...points, line]), "range-0");
  assert.equal(taken(100, 50, [line, ...points]), "opacity-0");
  assert.equal(taken(105, 160, [line]), undefined);
});
