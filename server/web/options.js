// SPDX-License-Identifier: BSD-3-Clause
/**
 * Effective options: those of a state, otherwise those with which the server was started.
 *
 * @typedef {import("./types.js").State} State
 */

/** Drawn elements, and the options for their appearance, which are refused without them. @type {{ drawn: (option: (word: string) => any) => boolean, how: string[] }[]} */
const dependent = [
  { drawn: (option) => Boolean(option("color-bar")), how: ["color-bar-title", "color-bar-range", "color-bar-scale", "field-unit"] },
  { drawn: (option) => ["box", "both"].includes(option("axes")) || Boolean(option("scale-bar")), how: ["length-unit"] },
  {
    drawn: (option) => ["color-bar", "axes", "outline", "scale-bar", "annotate"].some((word) => Boolean(option(word))),
    how: ["annotation-color", "annotation-size"],
  },
];

/** Refused with a function made of points, which already determine them. */
const in_points = ["rescale", "opacity-points"];

/**
 * A state in the form that the server accepts: without options that have no effect. null removes an option with which
 * the server was started.
 * @param {State} state @param {State} started @param {{ shaded?: boolean }} [first] whether the first picture is shaded by default
 * @returns {State}
 */
export function sent_state(state, started, { shaded = false } = {}) {
  const sent = { ...state };
  const option = (/** @type {string} */ word) => (sent[word] !== undefined ? sent[word] : started[word]);
  const leave_out = (/** @type {string} */ word) => {
    if (started[word]) sent[word] = null;
    else delete sent[word];
  };
  for (const { drawn, how } of dependent) if (!drawn(option)) how.forEach(leave_out);
  if (typeof state["transfer-function"] === "object" && state["transfer-function"] !== null) {
    in_points.forEach(leave_out);
    // Shading stays when the colours are edited.
    if (shaded && option("shade") === undefined && !option("no-shade")) sent.shade = true;
  }
  return sent;
}
