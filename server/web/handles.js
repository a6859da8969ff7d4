// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which handle of a drawing a press takes. Their reaches overlap, and the one that was drawn last lies on top of those
 * before: so it is the nearest.
 *
 * @typedef {object} Handle
 * @property {string} name
 * @property {number} x
 * @property {number} y
 * @property {number} [foot] of an upright line, which begins at y
 * @property {number} reach from how far it is taken
 * @property {number} [behind] added to its distance, so that others within it come first
 */

/** @param {Handle} handle @param {{x: number, y: number}} place */
function distance(handle, place) {
  const y = Math.max(handle.y, Math.min(handle.foot ?? handle.y, place.y));
  return Math.hypot(place.x - handle.x, place.y - y);
}

/**
 * @param {Handle[]} handles @param {{x: number, y: number}} place
 * @param {string} [selected] is taken where another one is as near
 * @returns {Handle | undefined} undefined: none is within reach
 */
export function nearest_handle(handles, place, selected) {
  const found = handles.map((handle) => ({ handle, at: distance(handle, place) })).filter(({ handle, at }) => at <= handle.reach)
    .map(({ handle, at }) => ({ handle, at: at + (handle.behind ?? 0) }));
  const least = Math.min(...found.map(({ at }) => at));
  const nearest = found.filter(({ at }) => at <= least + 1e-6);
  return (nearest.find(({ handle }) => handle.name === selected) ?? nearest[0])?.handle;
}
