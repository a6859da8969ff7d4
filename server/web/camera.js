// SPDX-License-Identifier: BSD-3-Clause
/**
 * Camera mathematics: the effect of gestures on a view. Every function returns a new camera and does not change its
 * argument.
 *
 * Picture coordinates are fractions of the picture's *height* from its middle, x to the right and y upwards: the top
 * edge is y = 0.5, the right edge x = 0.5 width / height. So no size in pixels is needed.
 *
 * @typedef {import("./types.js").Camera} Camera
 * @typedef {import("./types.js").Vector} Vector
 */
import { add, cross, dot, length, perpendicular, rotate, scale, subtract, unit } from "./vector.js";

const degree = Math.PI / 180;
/** The angle of a new perspective view, equal to the server's. */
const default_angle = 30;

/** @param {Camera} camera */
export const is_perspective = (camera) => camera.parallel_scale === undefined;

/** Whether an untrusted value is a view. @param {any} value */
export function is_camera(value) {
  const vector = (/** @type {any} */ v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
  const positive = (/** @type {any} */ v) => Number.isFinite(v) && v > 0;
  return typeof value === "object" && value !== null && vector(value.position) && vector(value.focal_point) && vector(value.view_up) &&
    (value.parallel_scale === undefined ? positive(value.view_angle) : positive(value.parallel_scale) && value.view_angle === undefined);
}

/**
 * Orthonormal axes: `up` points to the top of the picture, `forward` into it.
 * @param {Camera} camera
 * @returns {{right: Vector, up: Vector, forward: Vector}}
 */
export function basis_of(camera) {
  const forward = unit(subtract(camera.focal_point, camera.position));
  let right = cross(forward, camera.view_up);
  right = length(right) > 1e-12 * length(camera.view_up) ? unit(right) : perpendicular(forward);
  return { right, up: cross(right, forward), forward };
}

/** Distance from the eye to the focal point. @param {Camera} camera */
export const distance_of = (camera) => length(subtract(camera.focal_point, camera.position));

/** Height of the picture at the focal point, in world units. @param {Camera} camera */
export function height_at_focus(camera) {
  if (!is_perspective(camera)) return 2 * /** @type {number} */ (camera.parallel_scale);
  return 2 * distance_of(camera) * Math.tan(((camera.view_angle ?? default_angle) / 2) * degree);
}

/** The point of the focal plane that is seen at (x, y). @param {Camera} camera @param {number} x @param {number} y */
export function point_at(camera, x, y) {
  const { right, up } = basis_of(camera);
  const height = height_at_focus(camera);
  return add(camera.focal_point, add(scale(right, x * height), scale(up, y * height)));
}

/**
 * The position of a point in the picture, and its planar depth. Undefined if the point is behind a perspective eye.
 * @param {Camera} camera @param {Vector} point
 * @returns {{x: number, y: number, depth: number} | undefined}
 */
export function project(camera, point) {
  const { right, up, forward } = basis_of(camera);
  const offset = subtract(point, camera.position);
  const depth = dot(offset, forward);
  if (is_perspective(camera) && !(depth > 0)) return undefined;
  const height = is_perspective(camera) ? (height_at_focus(camera) * depth) / distance_of(camera) : height_at_focus(camera);
  return { x: dot(offset, right) / height, y: dot(offset, up) / height, depth };
}

/** The view with eye and focal point moved by a vector. @param {Camera} camera @param {Vector} by @returns {Camera} */
export const moved = (camera, by) => ({
  ...camera, position: add(camera.position, by), focal_point: add(camera.focal_point, by),
});

/**
 * The view turned about the focal point, as if a ball were dragged by (dx, dy) in units of the picture's height; half of it
 * is a quarter turn. The up direction turns too, so that every view can be reached.
 * @param {Camera} camera @param {number} dx @param {number} dy @returns {Camera}
 */
export function turned_as_ball(camera, dx, dy) {
  const { right, up } = basis_of(camera);
  const axis = add(scale(up, -dx), scale(right, dy));
  const angle = length(axis) * Math.PI;
  if (angle === 0) return camera;
  const about = unit(axis);
  const offset = rotate(subtract(camera.position, camera.focal_point), about, angle);
  return { ...camera, position: add(camera.focal_point, offset), view_up: unit(rotate(up, about, angle)) };
}

/**
 * The view turned as on a turntable: about `pole` by dx, over its horizon by dy, never past the pole. Afterwards the
 * pole points up in the picture.
 * @param {Camera} camera @param {number} dx @param {number} dy @param {Vector} pole @returns {Camera}
 */
export function turned_on_table(camera, dx, dy, pole) {
  const axis = unit(pole);
  const { right, up, forward } = basis_of(camera);
  // Seen from straight above, the heading is the direction of the picture's top; from below, the opposite.
  let heading = subtract(forward, scale(axis, dot(forward, axis)));
  if (length(heading) < 1e-3) heading = scale(up, -Math.sign(dot(forward, axis)));
  heading = unit(subtract(heading, scale(axis, dot(heading, axis))));
  if (length(heading) === 0) heading = cross(axis, right);
  const height = Math.asin(Math.max(-1, Math.min(1, -dot(forward, axis))));
  const limit = 89.9 * degree;
  const raised = Math.max(-limit, Math.min(limit, height - dy * Math.PI));
  const led = rotate(heading, axis, -dx * Math.PI);
  const to_eye = add(scale(led, -Math.cos(raised)), scale(axis, Math.sin(raised)));
  return { ...camera, position: add(camera.focal_point, scale(to_eye, distance_of(camera))), view_up: axis };
}

/** The view in which the scene is turned clockwise by `angle` radians. @param {Camera} camera @param {number} angle @returns {Camera} */
export function rolled(camera, angle) {
  const { up, forward } = basis_of(camera);
  return { ...camera, view_up: unit(rotate(up, forward, -angle)) };
}

/** The view in which the scene has followed a drag by (dx, dy). @param {Camera} camera @param {number} dx @param {number} dy @returns {Camera} */
export function panned(camera, dx, dy) {
  const { right, up } = basis_of(camera);
  const height = height_at_focus(camera);
  return moved(camera, add(scale(right, -dx * height), scale(up, -dy * height)));
}

/**
 * Magnified by `factor`; the point of the focal plane at (x, y) stays there. A perspective eye moves; its angle stays.
 * @param {Camera} camera @param {number} factor @param {number} [x] @param {number} [y] @returns {Camera}
 */
export function zoomed(camera, factor, x = 0, y = 0) {
  if (!(factor > 0) || !Number.isFinite(factor)) return camera;
  const held = point_at(camera, x, y);
  const pulled = (/** @type {Vector} */ p) => add(held, scale(subtract(p, held), 1 / factor));
  if (is_perspective(camera)) return { ...camera, position: pulled(camera.position), focal_point: pulled(camera.focal_point) };
  const by = subtract(pulled(camera.focal_point), camera.focal_point);
  return { ...moved(camera, by), parallel_scale: /** @type {number} */ (camera.parallel_scale) / factor };
}

/**
 * Flight: the eye moves by (right, up, forward) world units, together with its focal point.
 * @param {Camera} camera @param {Vector} by @returns {Camera}
 */
export function flown(camera, by) {
  const axes = basis_of(camera);
  return moved(camera, add(add(scale(axes.right, by[0]), scale(axes.up, by[1])), scale(axes.forward, by[2])));
}

/**
 * The eye stays but looks in another direction: the scene follows a drag by (dx, dy).
 * @param {Camera} camera @param {number} dx @param {number} dy @returns {Camera}
 */
export function looked(camera, dx, dy) {
  const { right, up } = basis_of(camera);
  const angle = (camera.view_angle ?? default_angle) * degree;
  let offset = rotate(subtract(camera.focal_point, camera.position), up, dx * angle);
  offset = rotate(offset, right, -dy * angle);
  const view_up = rotate(up, right, -dy * angle);
  return { ...camera, focal_point: add(camera.position, offset), view_up: unit(view_up) };
}

/**
 * The view in the given projection, with the same size of objects in the focal plane.
 * @param {Camera} camera @param {boolean} perspective @returns {Camera}
 */
export function with_projection(camera, perspective) {
  if (perspective === is_perspective(camera)) return camera;
  const { parallel_scale, view_angle, ...rest } = camera;
  if (!perspective) return { ...rest, parallel_scale: height_at_focus(camera) / 2 };
  const { forward } = basis_of(camera);
  const distance = /** @type {number} */ (parallel_scale) / Math.tan((default_angle / 2) * degree);
  return { ...rest, view_angle: default_angle, position: subtract(camera.focal_point, scale(forward, distance)) };
}

/** The view with another angle and the same size of objects in the focal plane. @param {Camera} camera @param {number} angle degrees @returns {Camera} */
export function with_angle(camera, angle) {
  if (!is_perspective(camera) || !(angle > 0) || !(angle < 180)) return camera;
  const distance = height_at_focus(camera) / 2 / Math.tan((angle / 2) * degree);
  const { forward } = basis_of(camera);
  return { ...camera, view_angle: angle, position: subtract(camera.focal_point, scale(forward, distance)) };
}

/** The view with `point` in the middle of the picture and as the centre of rotation. @param {Camera} camera @param {Vector} point @returns {Camera} */
export function centred(camera, point) {
  const { right, up } = basis_of(camera);
  const offset = subtract(point, camera.focal_point);
  const sideways = moved(camera, add(scale(right, dot(offset, right)), scale(up, dot(offset, up))));
  if (is_perspective(camera)) return moved(camera, offset);
  // Orthographic: the eye stays at its depth, since everything behind it is clipped.
  return { ...sideways, focal_point: dot(subtract(point, sideways.position), basis_of(camera).forward) > 0 ? point : sideways.focal_point };
}

/** Whether two views are the same to a relative `tolerance`. @param {Camera} a @param {Camera} b @param {number} [tolerance] */
export function same_view(a, b, tolerance = 1e-9) {
  if (is_perspective(a) !== is_perspective(b)) return false;
  const far = distance_of(a) + length(a.focal_point);
  const near = (/** @type {Vector} */ p, /** @type {Vector} */ q) => length(subtract(p, q)) <= tolerance * far;
  return near(a.position, b.position) && near(a.focal_point, b.focal_point) &&
    Math.abs(height_at_focus(a) - height_at_focus(b)) <= tolerance * height_at_focus(a) &&
    length(subtract(basis_of(a).up, basis_of(b).up)) <= tolerance;
}
