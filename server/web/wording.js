// SPDX-License-Identifier: BSD-3-Clause
/** The server's messages name options of `tessera render`; the page replaces them by the names of its controls. */

/** @type {Record<string, string>} */
export const controls = {
  size: "Size", camera: "View", view: "View", up: "View", azimuth: "View", elevation: "View", zoom: "View", fit: "Fit", projection: "Projection",
  field: "Field", "time-step": "Time step", block: "Blocks", smooth: "Smooth", threshold: "Threshold", clip: "Clip", iso: "Iso-surface", surface: "Surface",
  shade: "Shade the volume", "no-shade": "Shade the volume", "transfer-function": "Colour and opacity", rescale: "Full range", range: "Range", log: "Log values",
  opacity: "Opacity scale", "opacity-scale": "Opacity scale", "opacity-points": "Shape", "unit-distance": "Unit distance", "color-bar": "Colour bar",
  "color-bar-title": "Bar's title", "color-bar-range": "Colour bar", "color-bar-scale": "Colour bar", background: "Background", axes: "Axes",
  outline: "Outline", "scale-bar": "Scale bar", accuracy: "Accuracy",
};

/** Makes a sentence of a server's line, which begins in lower case and has no full stop. @param {string} line */
export const sentence_of = (line) => `${line.charAt(0).toUpperCase()}${line.slice(1)}${/[.!?]$/.test(line) ? "" : "."}`;

/**
 * A sentence of the server with the page's names, and without the advice to read the program's help. Commands in
 * backquotes stay, and so do options without a control, with which only the server can be started.
 * @param {string} sentence
 */
export const in_page_words = (sentence) => sentence.replace(/; see `tessera [^`]*--help[^`]*`/g, "").replace(/`[^`]*`|(?<![\w'-])--([a-z]+(?:-[a-z]+)*)/g,
  (/** @type {string} */ found, /** @type {string | undefined} */ option) => (option && controls[option] ? `“${controls[option]}”` : found));
