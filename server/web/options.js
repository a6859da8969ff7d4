// SPDX-License-Identifier: BSD-3-Clause
/**
 * Options as they are in force: a state's, else those that the server was started with.
 *
 * @typedef {import("./types.js").State} State
 */

/** What draws, and the options that say how, which are refused without it. @type {{ drawn: (option: (word: string) => any) => boolean, how: string[] }[]} */
const dependent = [
  { drawn: (option) => Boolean(option("color-bar")), how: ["color-bar-title", "color-bar-range", "color-bar-scale", "field-unit"] },
  { drawn: (option) => ["box", "both"].includes(option("axes")) || Boolean(option("scale-bar")), how: ["length-unit"] },
  {
    drawn: (option) => ["color-bar", "axes", "outline", "scale-bar", "annotate"].some((word) => Boolean(option(word))),
    how: ["annotation-color", "annotation-size"],
  },
];

/** Of a function that is made of points: they say it themselves. */
const in_points = ["rescale", "opacity-points"];

/**
 * A state as the server takes it: without options that nothing shows any more. null takes one away that the server was
 * started with.
 * @param {State} state @param {State} started @param {{ shaded?: boolean }} [first] whether the first picture is shaded unasked
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
    // The light stays when the colours are edited.
    if (shaded && option("shade") === undefined && !option("no-shade")) sent.shade = true;
  }
  return sent;
}
