// SPDX-License-Identifier: BSD-3-Clause
/**
 * Chooses the handle of a drawing that a press takes: the nearest one. Their reaches overlap, and the last drawn would
 * otherwise cover the others.
 *
 * @typedef {object} Handle
 * @property {string} name
 * @property {number} x
 * @property {number} y
 * @property {number} [foot] the end of a vertical line that begins at y
 * @property {number} reach largest distance from which it is taken
 * @property {number} [behind] added to its distance, so that other handles within it take precedence
 */

/** @param {Handle} handle @param {{x: number, y: number}} place */
function distance(handle, place) {
  const y = Math.max(handle.y, Math.min(handle.foot ?? handle.y, place.y));
  return Math.hypot(place.x - handle.x, place.y - y);
}

/**
 * @param {Handle[]} handles @param {{x: number, y: number}} place
 * @param {string} [selected] is taken if another one is equally near
 * @returns {Handle | undefined} undefined if none is within reach
 */
export function nearest_handle(handles, place, selected) {
  const found = handles.map((handle) => ({ handle, at: distance(handle, place) })).filter(({ handle, at }) => at <= handle.reach)
    .map(({ handle, at }) => ({ handle, at: at + (handle.behind ?? 0) }));
  const least = Math.min(...found.map(({ at }) => at));
  const nearest = found.filter(({ at }) => at <= least + 1e-6);
  return (nearest.find(({ handle }) => handle.name === selected) ?? nearest[0])?.handle;
}
