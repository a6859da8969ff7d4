// SPDX-License-Identifier: BSD-3-Clause
/**
 * Vectors of three numbers. No function changes its arguments.
 *
 * @typedef {import("./types.js").Vector} Vector
 */

/** @type {(a: Vector, b: Vector) => Vector} */
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

/** @type {(a: Vector, b: Vector) => Vector} */
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

/** @type {(a: Vector, factor: number) => Vector} */
export const scale = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];

/** @type {(a: Vector, b: Vector) => number} */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** @type {(a: Vector, b: Vector) => Vector} */
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** @type {(a: Vector) => number} */
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** The vector with unit length; (0, 0, 0) does not change. @type {(a: Vector) => Vector} */
export const unit = (a) => (length(a) > 0 ? scale(a, 1 / length(a)) : a);

/** @type {(a: Vector, b: Vector, t: number) => Vector} */
export const mix = (a, b, t) => add(scale(a, 1 - t), scale(b, t));

/**
 * `a` rotated by `angle` radians about `axis`, a unit vector; counterclockwise seen from the direction of the axis.
 * Source: Rodrigues' formula.
 * @type {(a: Vector, axis: Vector, angle: number) => Vector}
 */
export function rotate(a, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scale(a, c), scale(cross(axis, a), s)), scale(axis, dot(axis, a) * (1 - c)));
}

/** A unit vector at right angles to `a`, which is not zero. @type {(a: Vector) => Vector} */
export function perpendicular(a) {
  const smallest = a.map(Math.abs).indexOf(Math.min(...a.map(Math.abs)));
  /** @type {Vector} */
  const axis = [0, 0, 0];
  axis[smallest] = 1;
  return unit(cross(a, axis));
}
