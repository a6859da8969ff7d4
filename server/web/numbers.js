// SPDX-License-Identifier: BSD-3-Clause
/** Formatting and parsing of numbers, and axes. */

/**
 * Returns a short text with `digits` significant digits: 0.82, 12 300, 1.5e-7.
 * @param {number|null|undefined} value @param {number} [digits]
 */
export function short_number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "-∞";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  return String(Number(value.toPrecision(digits)));
}

/**
 * Returns a coordinate, rounded to a hundred-thousandth of the data's size, for data at any position.
 * @param {number} value @param {number} extent length of the data's diagonal
 */
export function short_place(value, extent) {
  if (Math.abs(value) < 1e-9 * extent) return "0";
  const digits = Math.ceil(Math.log10(Math.abs(value) / extent)) + 5;
  return short_number(value, Math.max(1, Math.min(15, digits)));
}

/** A count with thin spaces between thousands. @param {number} count */
export const counted = (count) => String(Math.round(count)).replace(/\B(?=(\d{3})+$)/g, "\u202f");

/** @param {number} milliseconds */
export function short_time(milliseconds) {
  if (milliseconds < 1000) return `${milliseconds < 10 ? milliseconds.toFixed(1) : Math.round(milliseconds)} ms`;
  return `${(milliseconds / 1000).toFixed(milliseconds < 10000 ? 2 : 1)} s`;
}

/** @param {number} bytes */
export const short_bytes = (bytes) => (bytes < 1000 ? `${bytes} bytes` : bytes < 1e6 ? `${short_number(bytes / 1e3, 3)} kB` : `${short_number(bytes / 1e6, 3)} MB`);

/**
 * Parses a typed number; accepts decimal commas. NaN for any other text.
 * @param {string} text
 */
export function parsed_number(text) {
  const word = text.trim().replace(",", ".").replace("−", "-");
  return word === "" ? Number.NaN : Number(word);
}

/**
 * Parses numbers separated by commas or blanks. Undefined unless there are `count` of them.
 * @param {string} text @param {number} count @returns {number[] | undefined}
 */
export function parsed_numbers(text, count) {
  const numbers = text.trim().split(/[\s,;]+/).map(Number);
  return numbers.length === count && numbers.every(Number.isFinite) ? numbers : undefined;
}

/** Round values from low to high, about `count` of them. @param {number} low @param {number} high @param {number} count @returns {number[]} */
export function linear_ticks(low, high, count) {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const rough = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= rough * (1 - 1e-9)) ?? 10);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) ticks.push(Number((i * step).toPrecision(12)));
  return ticks;
}

/** Powers of ten from low to high, or as many of them as `count`; linear ticks within a decade. @param {number} low @param {number} high @param {number} count */
export function log_ticks(low, high, count) {
  if (!(low > 0) || !(high > low)) return [low];
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9);
  if (last - first < 1) return linear_ticks(low, high, count);
  const step = Math.max(1, Math.ceil((last - first + 1) / count));
  const ticks = [];
  for (let e = first; e <= last; e += step) ticks.push(Number(`1e${e}`));
  return ticks;
}

/**
 * The position of a value on an axis, 0 at its low end and 1 at its high end.
 * @param {number} value @param {[number, number]} ends @param {boolean} log
 */
export function fraction_of(value, ends, log) {
  if (!log || !(ends[0] > 0)) return (value - ends[0]) / (ends[1] - ends[0]);
  return Math.log(Math.max(value, Number.MIN_VALUE) / ends[0]) / Math.log(ends[1] / ends[0]);
}

/** The value at a position on an axis, the reverse of fraction_of(). @param {number} fraction @param {[number, number]} ends @param {boolean} log */
export function value_of(fraction, ends, log) {
  if (!log || !(ends[0] > 0)) return ends[0] + fraction * (ends[1] - ends[0]);
  return ends[0] * (ends[1] / ends[0]) ** fraction;
}

/** The smallest opacity on a logarithmic axis; smaller ones count as 0. */
export const least_opacity = 1e-4;

/** Height of an opacity on its axis, 0 to 1. @param {number} opacity @param {boolean} log */
export function opacity_height(opacity, log) {
  if (!log) return opacity;
  return opacity < least_opacity ? 0 : 1 - Math.log10(opacity) / Math.log10(least_opacity);
}

/** The opacity at a height. The foot of a logarithmic axis is 0. @param {number} height @param {boolean} log */
export function opacity_at_height(height, log) {
  const at = Math.max(0, Math.min(1, height));
  if (!log) return at;
  return at < 0.005 ? 0 : least_opacity ** (1 - at);
}
