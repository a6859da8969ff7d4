// SPDX-License-Identifier: BSD-3-Clause
// The edited transfer function: what edits do, and what of the state they make.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as functions from "../../../server/web/transfer_function.js";

const json = {
  Name: "cool-warm", ColorSpace: "Lab", RGBPoints: [0, 0.2, 0.3, 0.8, 5, 0.9, 0.9, 0.9, 10, 0.7, 0, 0.1],
  Points: [0, 0, 0.5, 0, 10, 0.4, 0.5, 0], ScalarOpacityUnitDistance: 0.3,
};
const reply = {
  range: [0, 10], colors: [[0, 0.2, 0.3, 0.8], [10, 0.7, 0, 0.1]], opacities: [[0, 0], [10, 0.4]], unit_distance: 0.3, log: false,
  json, paraview: [json],
};

test("what was edited by nobody makes the same colour map again", () => {
  const made = functions.state_of(functions.edited_function(reply, json));
  assert.deepEqual(made["transfer-function"], json);
  assert.equal(made.range, "0,10");
});

test("points of a map that is used over another range are stretched by their ends", () => {
  const edited = functions.edited_function({ ...reply, range: [100, 200] }, json);
  assert.deepEqual(edited.colors.map((p) => p[0]), [0, 0.5, 1]);
  assert.deepEqual(functions.state_of(edited)["transfer-function"].RGBPoints.filter((_, i) => i % 4 === 0), [100, 150, 200]);
});

test("a logarithmic function has its points over the exponent", () => {
  const edited = functions.edited_function({ ...reply, range: [0.01, 100], log: true }, json);
  assert.deepEqual(functions.state_of(edited)["transfer-function"].RGBPoints.filter((_, i) => i % 4 === 0), [-2, 0, 2]);
  assert.equal(functions.state_of(edited).range, "0.01,100");
  assert.ok(Math.abs(functions.value_at(edited, 0.5) - 1) < 1e-12);
});

test("too many points become few that miss little", () => {
  const opacities = Array.from({ length: 500 }, (_, i) => [i / 499, 0.5 + 0.4 * Math.sin(i / 60)]);
  const edited = functions.edited_function({ ...reply, range: [0, 1], opacities });
  assert.ok(edited.opacities.length <= 24);
  for (const [t, opacity] of opacities) assert.ok(Math.abs(functions.opacity_at(edited, t) - opacity) < 0.02);
});

test("points with a midpoint of their own are replaced by what they draw", () => {
  const bent = { ...json, Points: [0, 0, 0.3, 0.5, 10, 1, 0.5, 0] };
  assert.deepEqual(functions.edited_function(reply, bent).opacities, [[0, 0], [1, 0.4]]);
});

test("the knots of a function that is no colour map become its points, and colours miss by nothing that is seen", () => {
  const colors = Array.from({ length: 300 }, (_, i) => [i / 29.9, Math.sin(i / 200), i / 299, 0.5]);
  const edited = functions.edited_function({ ...reply, colors, opacities: [[0, 0], [2, 0.04], [5, 0.1], [10, 0.2]] });
  assert.deepEqual(edited.opacities, [[0, 0], [1, 0.2]]);
  assert.ok(edited.colors.length <= 48);
  for (const [value, ...rgb] of colors)
    functions.color_at(edited, value / 10).forEach((v, k) => assert.ok(Math.abs(v - rgb[k]) < 0.5 / 255 + 1e-4));
});

test("few colours keep the ends and stay near", () => {
  const colors = Array.from({ length: 300 }, (_, i) => [i / 29.9, Math.sin(i / 200), i / 299, 0.5]);
  const plain = functions.edited_function({ ...reply, colors }), few = functions.with_few_colors(plain);
  assert.ok(few.colors.length <= 9);
  assert.deepEqual(few.colors[0], plain.colors[0]);
  for (const t of [0.1, 0.5, 0.8]) functions.color_at(few, t).forEach((v, k) => assert.ok(Math.abs(v - functions.color_at(plain, t)[k]) < 0.03));
});

test("points are without the overall opacity", () => {
  const edited = functions.edited_function({ ...reply, opacities: [[0, 0], [10, 0.75]] }, undefined, 2);
  assert.deepEqual(edited.opacities, [[0, 0], [1, 0.5]]);
});

test("a point moves between its neighbours, and the ends keep their place", () => {
  const { edited, index } = functions.with_point(functions.edited_function(reply), 0.5, 0.3);
  assert.equal(index, 1);
  assert.deepEqual(functions.with_opacity(edited, 1, 7, 2).opacities[1], [1, 1]);
  assert.deepEqual(functions.with_opacity(edited, 0, 0.4, 0.1).opacities[0], [0, 0.1]);
  assert.deepEqual(functions.with_opacity(edited, 2, 0.4, -1).opacities[2], [1, 0]);
  assert.equal(edited.opacities.length, 3);
});

test("a point added on the curve changes nothing, and one removed is gone", () => {
  const plain = functions.edited_function(reply);
  const { edited, index } = functions.with_point(plain, 0.25);
  for (const t of [0, 0.1, 0.3, 0.9]) assert.ok(Math.abs(functions.opacity_at(edited, t) - functions.opacity_at(plain, t)) < 1e-12);
  assert.deepEqual(functions.without_point(edited, index), plain);
  assert.equal(functions.without_point(plain, 0), plain);
});

test("points added at the ends stay inside of them", () => {
  const plain = functions.edited_function(reply);
  assert.equal(functions.with_point(plain, 0, 0.2).index, 1);
  assert.equal(functions.with_point(plain, 1, 0.2).index, 1);
});

test("colours are added, changed and removed", () => {
  const plain = functions.edited_function(reply);
  const { edited, index } = functions.with_color_point(plain, 0.25, [1, 0, 0]);
  assert.deepEqual(edited.colors[index], [0.25, 1, 0, 0]);
  assert.equal(functions.with_color_point(edited, 0.25, [0, 1, 0]).edited.colors.length, edited.colors.length);
  assert.deepEqual(functions.without_color(edited, index).colors, plain.colors);
});

test("colours reversed twice are the same", () => {
  const plain = functions.edited_function(reply);
  assert.deepEqual(functions.with_colors_reversed(functions.with_colors_reversed(plain)), plain);
  assert.deepEqual(functions.with_colors_reversed(plain).colors[0], [0, 0.7, 0, 0.1]);
});

test("colours are written as hex and read back", () => {
  assert.equal(functions.hex_color(functions.color_of_hex("#3b4cc0")), "#3b4cc0");
});

test("a file of ParaView's is taken, and another is refused with a sentence", () => {
  assert.deepEqual(functions.imported_function(JSON.stringify([{ ...json, Creator: "x" }])), json);
  assert.throws(() => functions.imported_function("{"), /not JSON/);
  assert.throws(() => functions.imported_function("[]"), /no RGBPoints/);
});
