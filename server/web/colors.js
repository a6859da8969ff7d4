// SPDX-License-Identifier: BSD-3-Clause
/** Conversion of options' colours to the form of the browser's controls. */

/** Converts linear light to an sRGB value, both from 0 to 1. @param {number} linear */
const encoded = (linear) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);

/**
 * "#rrggbb" for an option's colour, which may be of that form, a CSS name, or R,G,B in linear light, clamped to 1.
 * Undefined for any other word.
 * @param {string} word @param {(name: string) => string | undefined} [named]
 */
export function hex_of(word, named = hex_of_name) {
  if (/^#[0-9a-f]{6}$/i.test(word)) return word.toLowerCase();
  const channels = word.split(",").map((text) => (text.trim() === "" ? Number.NaN : Number(text)));
  if (channels.length === 3 && channels.every((c) => c >= 0))
    return `#${channels.map((c) => Math.round(255 * encoded(Math.min(1, c))).toString(16).padStart(2, "0")).join("")}`;
  return /^[a-z]+$/.test(word) ? named(word) : undefined;
}

/** Converts a CSS name, by means of the browser. @param {string} name */
function hex_of_name(name) {
  if (!CSS.supports("color", name)) return undefined;
  const context = /** @type {CanvasRenderingContext2D} */ (document.createElement("canvas").getContext("2d"));
  context.fillStyle = name;
  return /^#[0-9a-f]{6}$/.test(context.fillStyle) ? context.fillStyle : undefined;
}
