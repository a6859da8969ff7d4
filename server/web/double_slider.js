// SPDX-License-Identifier: BSD-3-Clause
/** Two handles on one axis, each one of the browser's sliders: for mouse, touch and keyboard. */
import { element, show_value, typed } from "./dom.js";
import { parsed_number, short_number } from "./numbers.js";

export class DoubleSlider {
  /**
   * @param {string} label @param {(ends: [number, number], moving: boolean) => void} change
   */
  constructor(label, change) {
    this.change = change;
    /** @type {[number, number]} */
    this.limits = [0, 1];
    /** @type {[number, number]} */
    this.ends = [0, 1];
    const slider = (/** @type {0|1} */ end) => element("input", {
      type: "range", min: 0, max: 1000, step: 1, "aria-label": `${label}, ${end ? "high" : "low"} end`,
      on_input: () => this.#slid(end, true), on_change: () => this.#slid(end, false),
    });
    this.sliders = /** @type {const} */ ([slider(0), slider(1)]);
    const text = (/** @type {0|1} */ end) => typed(`${label}, ${end ? "high" : "low"} end`, (word) => this.#typed(end, word));
    this.texts = /** @type {const} */ ([text(0), text(1)]);
    this.track = element("div", { class: "double-slider" }, ...this.sliders);
    this.element = element("div", { class: "double" }, element("span", { class: "label" }, label), this.texts[0], this.track, this.texts[1]);
  }

  /** @param {[number, number]} limits @param {[number, number]} ends */
  show(limits, ends) {
    this.limits = limits;
    this.ends = ends;
    const span = limits[1] - limits[0] || 1;
    this.sliders.forEach((slider, i) => show_value(slider, String(Math.round(((ends[i] - limits[0]) / span) * 1000))));
    this.texts.forEach((text, i) => show_value(text, short_number(ends[i], 5)));
    // If both handles are at the same place, the one that can still move is on top.
    this.sliders[0].style.zIndex = ends[0] - limits[0] > span / 2 ? "1" : "";
    this.track.style.setProperty("--low", String((ends[0] - limits[0]) / span));
    this.track.style.setProperty("--high", String((ends[1] - limits[0]) / span));
  }

  /** @param {0|1} end @param {boolean} moving */
  #slid(end, moving) {
    const at = Number(this.sliders[end].value);
    // A handle at the end of its range has exactly the value of the limit.
    const value = at === 0 ? this.limits[0] : at === 1000 ? this.limits[1]
      : Number((this.limits[0] + (at / 1000) * (this.limits[1] - this.limits[0])).toPrecision(6));
    this.#set(end, value, moving);
  }

  /** @param {0|1} end @param {string} word */
  #typed(end, word) {
    const value = parsed_number(word);
    if (Number.isNaN(value) || (end === 0 ? value >= this.ends[1] : value <= this.ends[0])) return false;
    this.#set(end, value, false, 0);
    return true;
  }

  /** @param {0|1} end @param {number} value @param {boolean} moving @param {number} least distance of the ends */
  #set(end, value, moving, least = (this.limits[1] - this.limits[0]) / 1000) {
    const ends = /** @type {[number, number]} */ ([...this.ends]);
    ends[end] = end === 0 ? Math.min(value, ends[1] - least) : Math.max(value, ends[0] + least);
    this.show(this.limits, ends);
    this.change(ends, moving);
  }
}
