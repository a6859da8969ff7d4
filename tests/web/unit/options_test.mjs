// SPDX-License-Identifier: BSD-3-Clause
// Options in force, and colours as controls have them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { hex_of } from "../../../server/web/colors.js";
import { sent_state } from "../../../server/web/options.js";

test("what says how something is drawn goes with it, the server's own by a null", () => {
  const started = { "color-bar": true, "color-bar-title": "t", "field-unit": "K" };
  assert.deepEqual(sent_state({}, started), {});
  assert.deepEqual(sent_state({ "color-bar": null }, started), { "color-bar": null, "color-bar-title": null, "field-unit": null });
  assert.deepEqual(sent_state({ "color-bar-title": "own", "color-bar-scale": "log" }, {}), {});
  assert.deepEqual(sent_state({ "color-bar": true, "color-bar-title": "own" }, {}), { "color-bar": true, "color-bar-title": "own" });
});

test("a unit of length stays while something shows lengths", () => {
  const started = { axes: "both", "scale-bar": "bottom", "length-unit": "mm", "annotation-size": "20" };
  assert.deepEqual(sent_state({ axes: null }, started), { axes: null });
  assert.deepEqual(sent_state({ axes: true, "scale-bar": null }, started), { axes: true, "scale-bar": null, "length-unit": null });
  assert.deepEqual(sent_state({ axes: null, "scale-bar": null }, started), { axes: null, "scale-bar": null, "length-unit": null, "annotation-size": null });
});

test("points of one's own take the place of those that the server was started with, and the light stays", () => {
  const map = { RGBPoints: [0, 0, 0, 0, 1, 1, 1, 1] };
  assert.deepEqual(sent_state({ "transfer-function": map }, { "opacity-points": "0:0,1:1" }), { "transfer-function": map, "opacity-points": null });
  assert.deepEqual(sent_state({ "transfer-function": "viridis" }, { "opacity-points": "0:0,1:1" }), { "transfer-function": "viridis" });
  assert.deepEqual(sent_state({ "transfer-function": map }, {}, { shaded: true }), { "transfer-function": map, shade: true });
  assert.deepEqual(sent_state({ "transfer-function": map, "no-shade": true }, {}, { shaded: true }), { "transfer-function": map, "no-shade": true });
  assert.deepEqual(sent_state({}, {}, { shaded: true }), {});
});

test("colours of options are shown by the browser's controls", () => {
  const named = (name) => ({ navy: "#000080" })[name];
  for (const [word, hex] of [["#A0b1C2", "#a0b1c2"], ["navy", "#000080"], ["0,0,0", "#000000"], ["1,1,3", "#ffffff"], ["0.2158605,0,1", "#8000ff"], ["nonsense", undefined],
    ["1,2", undefined], ["1,,2", undefined], ["-1,0,0", undefined], ["#12", undefined], ["", undefined]])
    assert.equal(hex_of(word, named), hex, word);
});
