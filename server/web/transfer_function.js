// SPDX-License-Identifier: BSD-3-Clause
/**
 * The transfer function in the editor's form: points at fractions of a range, 0 at its low end and 1 at its high end,
 * which do not change with the range or a logarithmic scale. No function changes its arguments.
 *
 * Both lists begin at 0, end at 1 and do not decrease: the points of a file are converted from the interval between
 * their own ends, which becomes the function's range.
 *
 * @typedef {import("./types.js").FunctionReply} FunctionReply
 * @typedef {[number, number]} OpacityPoint fraction, opacity per unit distance
 * @typedef {[number, number, number, number]} ColorPoint fraction, sRGB from 0 to 1
 *
 * @typedef {object} EditedFunction
 * @property {[number, number]} range
 * @property {boolean} log
 * @property {ColorPoint[]} colors
 * @property {OpacityPoint[]} opacities
 * @property {string} color_space
 * @property {number} [hsv_wrap]
 * @property {number} [unit_distance]
 * @property {string} name
 */
import { fraction_of, value_of } from "./numbers.js";

/** @param {number[]} list @param {number} width @returns {number[][]} */
const in_groups = (list, width) => Array.from({ length: Math.floor(list.length / width) }, (_, i) => list.slice(i * width, (i + 1) * width));

/**
 * A subset of the points whose connecting lines miss no point by more than `tolerance`, in any component but the first.
 * Source: Douglas, Peucker, "Algorithms for the reduction of the number of points", Cartographica, 1973; by height
 * alone.
 * @param {number[][]} points @param {number} tolerance @returns {number[][]}
 */
export function simplified(points, tolerance) {
  if (points.length < 3) return points;
  const kept = new Set([0, points.length - 1]);
  const spans = [[0, points.length - 1]];
  for (let span = spans.pop(); span; span = spans.pop()) {
    const [first, last] = span;
    const from = points[first], to = points[last];
    let worst = -1, most = tolerance;
    for (let i = first + 1; i < last; ++i) {
      const t = to[0] > from[0] ? (points[i][0] - from[0]) / (to[0] - from[0]) : 0;
      const miss = Math.max(...points[i].slice(1).map((v, k) => Math.abs(v - from[k + 1] - t * (to[k + 1] - from[k + 1]))));
      if (miss > most) [worst, most] = [i, miss];
    }
    if (worst < 0) continue;
    kept.add(worst);
    spans.push([first, worst], [worst, last]);
  }
  return points.filter((_, i) => kept.has(i));
}

/**
 * Simplified with the smallest tolerance, doubled from `tolerance`, that gives at most `most` points; or `many`, if
 * that would need more than `limit`.
 * @param {number[][]} points @param {{tolerance: number, most: number, limit: number, many: number}} wanted
 */
function fewer(points, { tolerance, most, limit, many }) {
  let few = simplified(points, tolerance);
  for (let coarse = 2 * tolerance; few.length > many || (few.length > most && coarse <= limit); coarse *= 2) few = simplified(points, coarse);
  return few;
}

/** Opacities: an error above `limit` is visible. Colours: always half a step of eight bits. */
const few_opacities = { tolerance: 1e-4, most: 10, limit: 4e-3, many: 24 }, few_colors = { tolerance: 2e-3, most: 16, limit: 2e-3, many: 48 };
/** Most colours that have a handle each. */
export const most_handles = 16;

/**
 * The same points with one at 0 and one at 1.
 * @template {number[]} T @param {T[]} points @returns {T[]}
 */
function with_ends(points) {
  const result = points.map((p) => /** @type {T} */ ([Math.max(0, Math.min(1, p[0])), ...p.slice(1)]));
  if (result[0][0] > 0) result.unshift(/** @type {T} */ ([0, ...result[0].slice(1)]));
  const last = result[result.length - 1];
  if (last[0] < 1) result.push(/** @type {T} */ ([1, ...last.slice(1)]));
  return result;
}

/** Points of a file as points over its own ends. @param {number[][]} points @returns {number[][]} */
function over_own_ends(points) {
  const low = points[0][0], span = points[points.length - 1][0] - low;
  return points.map((p) => [span > 0 ? (p[0] - low) / span : 0, ...p.slice(1)]);
}

/** The opacity of an extinction `factor` times as large. @param {number} opacity @param {number} factor */
const scaled_opacity = (opacity, factor) => (factor === 1 ? opacity : 1 - (1 - opacity) ** factor);

/**
 * The reply of api/function in the editor's form. `own`: the colour map of the state, whose points are kept unchanged;
 * any other function is simplified to its essential knots. `factor`: the state's overall opacity, which points exclude.
 * @param {FunctionReply} reply @param {any} [own] @param {number} [factor] @returns {EditedFunction}
 */
export function edited_function(reply, own, factor = 1) {
  const { log } = reply;
  const at = (/** @type {number[]} */ p) => [fraction_of(p[0], reply.range, log), ...p.slice(1)];
  const map = own?.RGBPoints?.length >= 8 ? own : undefined;
  const stops = /** @type {ColorPoint[]} */ (map ? over_own_ends(in_groups(map.RGBPoints, 4)) : fewer(reply.colors.map(at), few_colors));
  const own_points = in_groups(map?.Points ?? [], 4);
  const plain = own_points.length > 1 && own_points.every((p) => p[2] === 0.5 && !p[3]);
  const points = /** @type {OpacityPoint[]} */ (plain ? over_own_ends(own_points).map((p) => [p[0], p[1]])
    : fewer(reply.opacities.map((p) => at([p[0], scaled_opacity(p[1], 1 / factor)])), few_opacities));
  return {
    range: reply.range, log, colors: with_ends(stops), opacities: with_ends(points), color_space: map?.ColorSpace ?? "RGB", hsv_wrap: map?.HSVWrap,
    unit_distance: map?.ScalarOpacityUnitDistance ?? reply.unit_distance, name: map?.Name ?? "function",
  };
}

/**
 * The options of this function. Points of a logarithmic function are over the base-10 logarithm.
 * @param {EditedFunction} edited @returns {{"transfer-function": Record<string, any>, range: string}}
 */
export function state_of(edited) {
  const [low, high] = edited.range;
  const ends = /** @type {[number, number]} */ (edited.log && low > 0 ? [Math.log10(low), Math.log10(high)] : [low, high]);
  // The ends are exactly the range's numbers, so that stretching over it changes no bit.
  const x = (/** @type {number} */ t) => (t === 0 ? ends[0] : t === 1 ? ends[1] : Number((ends[0] + t * (ends[1] - ends[0])).toPrecision(10)));
  const round = (/** @type {number} */ v) => Number(v.toPrecision(6));
  return {
    "transfer-function": {
      Name: edited.name, ColorSpace: edited.color_space, ...(edited.hsv_wrap ? { HSVWrap: edited.hsv_wrap } : {}),
      RGBPoints: edited.colors.flatMap(([t, ...rgb]) => [x(t), ...rgb.map(round)]),
      Points: edited.opacities.flatMap(([t, opacity]) => [x(t), round(opacity), 0.5, 0]),
      ...(edited.unit_distance ? { ScalarOpacityUnitDistance: edited.unit_distance } : {}),
    },
    range: `${low},${high}`,
  };
}

/** @param {EditedFunction} edited @param {number} t @returns {number} */
export function opacity_at(edited, t) {
  const list = edited.opacities;
  let i = list.findIndex((p) => p[0] > t);
  if (i < 0) i = list.length;
  if (i === 0) return list[0][1];
  if (i === list.length) return list[i - 1][1];
  const [a, b] = [list[i - 1], list[i]];
  return a[1] + ((t - a[0]) / (b[0] - a[0])) * (b[1] - a[1]);
}

/** Linear between the stops: close to the drawn colour in any colour space. @param {EditedFunction} edited @param {number} t @returns {[number, number, number]} */
export function color_at(edited, t) {
  const list = edited.colors;
  let i = list.findIndex((p) => p[0] > t);
  if (i < 0) i = list.length;
  const a = list[Math.max(0, i - 1)], b = list[Math.min(list.length - 1, i)];
  const f = b[0] > a[0] ? (t - a[0]) / (b[0] - a[0]) : 0;
  return [a[1] + f * (b[1] - a[1]), a[2] + f * (b[2] - a[2]), a[3] + f * (b[3] - a[3])];
}

/**
 * The fraction `t` for point `index` of a list, limited by its neighbours; the two ends keep theirs.
 * @template {number[]} T @param {T[]} list @param {number} index @param {number} t
 */
function allowed_fraction(list, index, t) {
  if (index === 0) return 0;
  if (index === list.length - 1) return 1;
  return Math.max(list[index - 1][0], Math.min(list[index + 1][0], t));
}

/** @param {EditedFunction} edited @param {number} index @param {number} t @param {number} opacity @returns {EditedFunction} */
export function with_opacity(edited, index, t, opacity) {
  const opacities = edited.opacities.slice();
  opacities[index] = [allowed_fraction(opacities, index, t), Math.max(0, Math.min(1, opacity))];
  return { ...edited, opacities };
}

/** Adds a point; also returns its index. @param {EditedFunction} edited @param {number} t @param {number} [opacity] @returns {{edited: EditedFunction, index: number}} */
export function with_point(edited, t, opacity = opacity_at(edited, t)) {
  const at = Math.max(0, Math.min(1, t));
  const opacities = edited.opacities.slice();
  const found = opacities.findIndex((p) => p[0] > at);
  const index = found < 0 ? opacities.length - 1 : Math.max(1, found);
  opacities.splice(index, 0, [at, Math.max(0, Math.min(1, opacity))]);
  return { edited: { ...edited, opacities }, index };
}

/** The ends cannot be removed. @param {EditedFunction} edited @param {number} index @returns {EditedFunction} */
export function without_point(edited, index) {
  if (index <= 0 || index >= edited.opacities.length - 1) return edited;
  return { ...edited, opacities: edited.opacities.filter((_, i) => i !== index) };
}

/** @param {EditedFunction} edited @param {number} index @param {number} t @param {number[]} rgb @returns {EditedFunction} */
export function with_color(edited, index, t, rgb) {
  const colors = edited.colors.slice();
  colors[index] = [allowed_fraction(colors, index, t), rgb[0], rgb[1], rgb[2]];
  return { ...edited, colors, name: "function" };
}

/** @param {EditedFunction} edited @param {number} t @param {number[]} [rgb] @returns {{edited: EditedFunction, index: number}} */
export function with_color_point(edited, t, rgb = color_at(edited, t)) {
  const at = Math.max(0, Math.min(1, t));
  const same = edited.colors.findIndex((p) => Math.abs(p[0] - at) < 1e-9);
  if (same >= 0) return { edited: with_color(edited, same, at, rgb), index: same };
  const found = edited.colors.findIndex((p) => p[0] > at);
  const index = found < 0 ? edited.colors.length - 1 : Math.max(1, found);
  const colors = edited.colors.slice();
  colors.splice(index, 0, [at, rgb[0], rgb[1], rgb[2]]);
  return { edited: { ...edited, colors, name: "function" }, index };
}

/** @param {EditedFunction} edited @param {number} index @returns {EditedFunction} */
export function without_color(edited, index) {
  if (index <= 0 || index >= edited.colors.length - 1) return edited;
  return { ...edited, colors: edited.colors.filter((_, i) => i !== index), name: "function" };
}

/** The few most significant colours, so that each has a handle. @param {EditedFunction} edited @returns {EditedFunction} */
export function with_few_colors(edited) {
  const colors = /** @type {ColorPoint[]} */ (fewer(edited.colors, { tolerance: 4e-3, most: 9, limit: 1, many: 9 }));
  return { ...edited, colors, name: "function" };
}

/** Reverses the colours. @param {EditedFunction} edited @returns {EditedFunction} */
export function with_colors_reversed(edited) {
  const colors = edited.colors.map(([t, ...rgb]) => /** @type {ColorPoint} */ ([1 - t, ...rgb])).reverse();
  return { ...edited, colors, name: edited.name.endsWith(" reversed") ? edited.name.slice(0, -9) : `${edited.name} reversed` };
}

/** @param {EditedFunction} edited @param {number} t */
export const value_at = (edited, t) => value_of(t, edited.range, edited.log);

/** "#rrggbb". @param {number[]} rgb */
export const hex_color = (rgb) => `#${rgb.slice(0, 3).map((v) => Math.round(Math.max(0, Math.min(1, v)) * 255).toString(16).padStart(2, "0")).join("")}`;

/** @param {string} hex @returns {[number, number, number]} */
export const color_of_hex = (hex) => /** @type {[number, number, number]} */ ([1, 3, 5].map((i) => Number.parseInt(hex.slice(i, i + 2), 16) / 255));

/**
 * The colour map in a ParaView file: an object, or the first of a list. Throws an Error with a sentence for anything
 * else.
 * @param {string} text @returns {Record<string, any>}
 */
export function imported_function(text) {
  let value;
  try {
    value = JSON.parse(text);
  } catch {
    throw new Error("The file is not JSON; export the colour map from ParaView's colour map editor as .json.");
  }
  const map = Array.isArray(value) ? value[0] : value;
  if (!Array.isArray(map?.RGBPoints) || map.RGBPoints.length < 4)
    throw new Error("The file has no RGBPoints, so it is not a colour map; export one from ParaView's colour map editor.");
  const known = ["Name", "ColorSpace", "HSVWrap", "RGBPoints", "Points", "ScalarOpacityUnitDistance", "NanColor"];
  return Object.fromEntries(known.filter((word) => map[word] !== undefined).map((word) => [word, map[word]]));
}
