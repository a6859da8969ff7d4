// SPDX-License-Identifier: BSD-3-Clause
// Numbers as they are read, typed and laid along axes.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as numbers from "../../../server/web/numbers.js";

test("numbers are short and keep their value", () => {
  assert.equal(numbers.short_number(0.8202634), "0.8203");
  assert.equal(numbers.short_number(1.5e-7), "1.5e-7");
  assert.equal(numbers.short_number(2e9), "2e9");
  assert.equal(numbers.short_number(0), "0");
  assert.equal(numbers.short_number(-12.5), "-12.5");
  assert.equal(numbers.short_number(null), "–");
  assert.equal(numbers.counted(1234567), "1\u202f234\u202f567");
});

test("places are told apart within the data, wherever they lie", () => {
  assert.equal(numbers.short_place(311335.843, 5000), "311335.8");
  assert.equal(numbers.short_place(7479123.456, 50), "7479123.456");
  assert.equal(numbers.short_place(-2062.4321, 5000), "-2062.4");
  assert.equal(numbers.short_place(0.5, 2), "0.5");
  assert.equal(numbers.short_place(1e-12, 2), "0");
  assert.equal(numbers.short_place(1 / 3, 1), "0.33333");
});

test("times have their unit", () => {
  assert.equal(numbers.short_time(4.25), "4.3 ms");
  assert.equal(numbers.short_time(212.4), "212 ms");
  assert.equal(numbers.short_time(12345), "12.3 s");
});

test("typed numbers are read, and nothing else", () => {
  assert.equal(numbers.parsed_number(" 1,5 "), 1.5);
  assert.ok(Number.isNaN(numbers.parsed_number("")));
  assert.ok(Number.isNaN(numbers.parsed_number("two")));
  assert.deepEqual(numbers.parsed_numbers("1, 2 3", 3), [1, 2, 3]);
  assert.equal(numbers.parsed_numbers("1 2", 3), undefined);
  assert.equal(numbers.parsed_numbers("1 2 x", 3), undefined);
});

test("ticks are round, inside, and about as many as asked for", () => {
  assert.deepEqual(numbers.linear_ticks(0, 1, 5), [0, 0.2, 0.4, 0.6, 0.8, 1]);
  assert.deepEqual(numbers.linear_ticks(3, 3, 5), [3]);
  for (const [low, high] of [[-2.5, 10.5], [1e-9, 3e-9], [1234, 98765]])
    for (const tick of numbers.linear_ticks(low, high, 5)) assert.ok(tick >= low && tick <= high);
  assert.deepEqual(numbers.log_ticks(0.01, 100, 9), [0.01, 0.1, 1, 10, 100]);
  assert.ok(numbers.log_ticks(1e-30, 1e30, 6).length <= 7);
  assert.ok(numbers.log_ticks(2, 7, 4).length > 2);
});

test("fractions and values are each other's reverse", () => {
  for (const log of [false, true])
    for (const t of [0, 0.25, 1]) assert.ok(Math.abs(numbers.fraction_of(numbers.value_of(t, [0.5, 80], log), [0.5, 80], log) - t) < 1e-12);
});

test("a logarithmic opacity axis has room near zero, and its foot is 0", () => {
  assert.equal(numbers.opacity_height(0, true), 0);
  assert.ok(numbers.opacity_height(0.01, true) > 0.4);
  assert.equal(numbers.opacity_height(1, true), 1);
  assert.equal(numbers.opacity_at_height(0, true), 0);
  for (const opacity of [0.001, 0.03, 0.9])
    assert.ok(Math.abs(numbers.opacity_at_height(numbers.opacity_height(opacity, true), true) - opacity) < 1e-12);
});
