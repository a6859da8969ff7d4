// SPDX-License-Identifier: BSD-3-Clause
// Camera mathematics: truths about views, on random cameras of a fixed seed.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as camera_of from "../../../server/web/camera.js";
import * as vector from "../../../server/web/vector.js";

/** A generator of numbers in [0, 1): mulberry32. */
function random_numbers(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

function random_cameras(count) {
  const next = random_numbers(7);
  const point = (size) => [0, 0, 0].map(() => (next() - 0.5) * size);
  return Array.from({ length: count }, (_, i) => ({
    position: point(20), focal_point: point(4), view_up: vector.unit(point(1)),
    ...(i % 2 ? { view_angle: 10 + 80 * next() } : { parallel_scale: 0.1 + 5 * next() }),
  }));
}

const near = (a, b, tolerance = 1e-9) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);
const near_vector = (a, b, tolerance = 1e-9) => near(vector.length(vector.subtract(a, b)), 0, tolerance);

test("the basis is orthonormal and right-handed", () => {
  for (const camera of random_cameras(50)) {
    const { right, up, forward } = camera_of.basis_of(camera);
    for (const axis of [right, up, forward]) near(vector.length(axis), 1);
    near(vector.dot(right, up), 0);
    near_vector(vector.cross(right, up), vector.scale(forward, -1));
  }
});

test("a view up along the view still gives axes", () => {
  const { right, up, forward } = camera_of.basis_of({ position: [0, 0, 5], focal_point: [0, 0, 0], view_up: [0, 0, 1], parallel_scale: 1 });
  for (const axis of [right, up]) near(vector.dot(axis, forward), 0);
  near(vector.length(right), 1);
});

test("a point of the focal plane is seen where it was taken from", () => {
  for (const camera of random_cameras(50)) {
    const seen = camera_of.project(camera, camera_of.point_at(camera, 0.3, -0.2));
    near(seen.x, 0.3);
    near(seen.y, -0.2);
    near(seen.depth, camera_of.distance_of(camera), 1e-8);
  }
});

test("what lies behind a perspective eye is not seen", () => {
  const camera = { position: [0, 0, 5], focal_point: [0, 0, 0], view_up: [0, 1, 0], view_angle: 30 };
  assert.equal(camera_of.project(camera, [0, 0, 6]), undefined);
});

test("zoom keeps the point under the cursor and enlarges by its factor", () => {
  for (const camera of random_cameras(50)) {
    const held = camera_of.point_at(camera, -0.4, 0.1);
    const nearer = camera_of.zoomed(camera, 1.7, -0.4, 0.1);
    const seen = camera_of.project(nearer, held);
    near(seen.x, -0.4, 1e-8);
    near(seen.y, 0.1, 1e-8);
    near(camera_of.height_at_focus(nearer) * 1.7, camera_of.height_at_focus(camera), 1e-8);
    assert.ok(camera_of.same_view(camera_of.zoomed(nearer, 1 / 1.7, -0.4, 0.1), camera));
  }
});

test("zoom by nonsense changes nothing", () => {
  const [camera] = random_cameras(1);
  for (const factor of [0, -1, Number.NaN, Number.POSITIVE_INFINITY]) assert.equal(camera_of.zoomed(camera, factor), camera);
});

test("a pan moves what is in the middle by the drag", () => {
  for (const camera of random_cameras(50)) {
    const seen = camera_of.project(camera_of.panned(camera, 0.25, -0.125), camera.focal_point);
    near(seen.x, 0.25);
    near(seen.y, -0.125);
  }
});

test("a ball keeps distance and centre, and comes back", () => {
  for (const camera of random_cameras(50)) {
    const turned = camera_of.turned_as_ball(camera, 0.2, 0.3);
    near(camera_of.distance_of(turned), camera_of.distance_of(camera), 1e-9);
    assert.deepEqual(turned.focal_point, camera.focal_point);
    const straight = { ...camera, view_up: camera_of.basis_of(camera).up };
    assert.ok(camera_of.same_view(camera_of.turned_as_ball(turned, -0.2, -0.3), straight, 1e-6));
    const twice = camera_of.turned_as_ball(camera_of.turned_as_ball(camera, 1, 0), 1, 0);
    assert.ok(camera_of.same_view(twice, straight, 1e-8));
  }
});

test("what is near the eye follows the drag of a ball", () => {
  const camera = { position: [0, 0, 5], focal_point: [0, 0, 0], view_up: [0, 1, 0], parallel_scale: 1 };
  assert.ok(camera_of.project(camera_of.turned_as_ball(camera, 0.1, 0), [0, 0, 1]).x > 0);
  assert.ok(camera_of.project(camera_of.turned_as_ball(camera, 0, 0.1), [0, 0, 1]).y > 0);
});

test("a table keeps its pole upright and does not pass it", () => {
  const pole = [0, 0, 1];
  for (const camera of random_cameras(50)) {
    const turned = camera_of.turned_on_table(camera, 0.2, 5, pole);
    const { right, up, forward } = camera_of.basis_of(turned);
    near(vector.dot(right, pole), 0);
    assert.ok(vector.dot(up, pole) > 0);
    near(vector.dot(forward, pole), Math.sin((89.9 * Math.PI) / 180), 1e-9);
    near(camera_of.distance_of(turned), camera_of.distance_of(camera), 1e-9);
  }
});

test("what is near the eye follows the drag of a table", () => {
  const camera = { position: [0, -5, 0], focal_point: [0, 0, 0], view_up: [0, 0, 1], view_angle: 40 };
  assert.ok(camera_of.project(camera_of.turned_on_table(camera, 0.1, 0, [0, 0, 1]), [0, -1, 0]).x > 0);
  assert.ok(camera_of.project(camera_of.turned_on_table(camera, 0, 0.1, [0, 0, 1]), [0, -1, 0]).y > 0);
});

test("a table seen from straight above keeps its heading", () => {
  const above = { position: [0, 0, 5], focal_point: [0, 0, 0], view_up: [0, 1, 0], parallel_scale: 1 };
  const turned = camera_of.turned_on_table(above, 0, 0, [0, 0, 1]);
  assert.ok(vector.dot(camera_of.basis_of(turned).right, [1, 0, 0]) > 0.999);
});

test("a roll turns what is seen clockwise", () => {
  for (const camera of random_cameras(20)) {
    const seen = camera_of.project(camera_of.rolled(camera, Math.PI / 2), camera_of.point_at(camera, 0, 0.3));
    near(seen.x, 0.3);
    near(seen.y, 0);
  }
});

test("flight takes the focal point along", () => {
  for (const camera of random_cameras(20)) {
    const flown = camera_of.flown(camera, [1, 2, 3]);
    const { right, up, forward } = camera_of.basis_of(camera);
    const by = vector.subtract(flown.position, camera.position);
    near(vector.dot(by, right), 1);
    near(vector.dot(by, up), 2);
    near(vector.dot(by, forward), 3);
    near(camera_of.distance_of(flown), camera_of.distance_of(camera));
  }
});

test("looking round keeps the eye, and what is seen follows the drag", () => {
  for (const camera of random_cameras(20)) {
    const looked = camera_of.looked(camera, 0.05, 0);
    assert.deepEqual(looked.position, camera.position);
    near(camera_of.distance_of(looked), camera_of.distance_of(camera));
    if (camera_of.is_perspective(camera)) assert.ok(camera_of.project(looked, camera.focal_point).x > 0);
    const lower = camera_of.looked(camera, 0, 0.05);
    if (camera_of.is_perspective(camera)) assert.ok(camera_of.project(lower, camera.focal_point).y > 0);
  }
});

test("another projection keeps the size at the focal point", () => {
  for (const camera of random_cameras(20)) {
    const other = camera_of.with_projection(camera, !camera_of.is_perspective(camera));
    assert.notEqual(camera_of.is_perspective(other), camera_of.is_perspective(camera));
    near(camera_of.height_at_focus(other), camera_of.height_at_focus(camera), 1e-9);
    assert.equal(Object.keys(other).filter((word) => word === "parallel_scale" || word === "view_angle").length, 1);
  }
});

test("another angle keeps the size at the focal point", () => {
  const [, camera] = random_cameras(2);
  const wide = camera_of.with_angle(camera, 100);
  near(camera_of.height_at_focus(wide), camera_of.height_at_focus(camera), 1e-9);
  assert.equal(camera_of.with_angle(camera, 180), camera);
});

test("a centred point is in the middle", () => {
  for (const camera of random_cameras(20)) {
    const point = vector.add(camera.focal_point, vector.scale(camera_of.basis_of(camera).up, 0.3));
    const seen = camera_of.project(camera_of.centred(camera, point), point);
    near(seen.x, 0);
    near(seen.y, 0);
  }
});
