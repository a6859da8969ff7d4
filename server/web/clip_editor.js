// SPDX-License-Identifier: BSD-3-Clause
/**
 * A box and planes that cut the data, in the state as `clip` options: "box:..." and "point, normal".
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./types.js").Vector} Vector
 */
import { basis_of } from "./camera.js";
import { button, checkbox, choice, element, icon_button, show_value, typed } from "./dom.js";
import { DoubleSlider } from "./double_slider.js";
import { parsed_number, short_number } from "./numbers.js";
import { dot, scale, unit } from "./vector.js";

/** @type {[string, Vector][]} */
const normals = [["keep the +x side", [1, 0, 0]], ["keep the -x side", [-1, 0, 0]], ["keep the +y side", [0, 1, 0]], ["keep the -y side", [0, -1, 0]], ["keep the +z side", [0, 0, 1]], ["keep the -z side", [0, 0, -1]]];

/** The values of an option as a list. @param {any} value @returns {string[]} */
const listed = (value) => (value ? [value].flat().map(String) : []);
const is_box = (/** @type {string} */ word) => word.startsWith("box:");
const digits = (/** @type {number} */ v) => Number(v.toPrecision(7));

export class ClipEditor {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.box_on = checkbox("Clip by a box", (on) => this.#set_box(on ? this.#bounds() : undefined, false), "Cut away what is outside of the box");
    this.sliders = ["x", "y", "z"].map((axis, i) => new DoubleSlider(axis, (ends, moving) => {
      const box = this.#box() ?? this.#bounds();
      [box[i], box[i + 3]] = ends;
      this.#set_box(box, moving);
    }));
    this.box = element("div", { class: "group" }, ...this.sliders.map((s) => s.element));
    this.planes = element("div", { class: "group" });
    this.element = element("div", { class: "clip" }, element("div", { class: "checks" }, this.box_on.label), this.box, this.planes,
      element("div", { class: "buttons" }, button("Add a clip plane", () => this.#add_plane(), { title: "Cut away what is behind a plane" })));
  }

  begin() {}

  #bounds() {
    return this.page.whole_bounds.flat();
  }

  get #clips() {
    return listed(this.page.option("clip"));
  }

  #box() {
    return this.#clips.find(is_box)?.slice(4).split(",").map(Number);
  }

  /** @param {number[] | undefined} box @param {boolean} moving */
  #set_box(box, moving) {
    this.#set([...(box ? [`box:${box.map(digits).join(",")}`] : []), ...this.#clips.filter((word) => !is_box(word))], moving);
  }

  /** @param {string[]} clips @param {boolean} moving */
  #set(clips, moving) {
    this.page.history.change({ clip: clips.length > 0 ? clips : this.page.unset("clip") }, { moving, name: "clip" });
  }

  /** @param {number} index @param {string | undefined} plane @param {boolean} moving */
  #set_plane(index, plane, moving) {
    const planes = this.#clips.filter((word) => !is_box(word));
    planes.splice(index, 1, ...(plane ? [plane] : []));
    this.#set([...this.#clips.filter(is_box), ...planes], moving);
  }

  #add_plane() {
    const [low, high] = this.page.whole_bounds;
    const middle = low.map((v, i) => digits((v + high[i]) / 2));
    this.#set([...this.#clips, `${middle.join(",")},0,1,0`], false);
  }

  /** Least and greatest distance of the data's box along a direction from the origin. @param {Vector} normal @returns {[number, number]} */
  #span(normal) {
    const [low, high] = this.page.whole_bounds;
    const at = (/** @type {boolean} */ most) => normal.reduce((sum, n, i) => sum + n * (n > 0 === most ? high[i] : low[i]), 0);
    return [at(false), at(true)];
  }

  update() {
    const box = this.#box();
    this.box_on.input.checked = box !== undefined;
    this.box.hidden = box === undefined;
    const bounds = this.#bounds(), shown = box ?? bounds;
    this.sliders.forEach((slider, i) => slider.show([bounds[i], bounds[i + 3]], [shown[i], shown[i + 3]]));
    const planes = this.#clips.filter((word) => !is_box(word));
    // The rows are not replaced while a slider is dragged.
    if (planes.length !== this.planes.children.length) this.planes.replaceChildren(...planes.map((_, i) => this.#plane_row(i)));
    planes.forEach((word, i) => this.#show_plane(i, word.split(",").map(Number)));
  }

  /** @param {number} index */
  #plane_row(index) {
    const read = () => {
      const n = this.#clips.filter((word) => !is_box(word))[index].split(",").map(Number);
      return { point: /** @type {Vector} */ (n.slice(0, 3)), normal: unit(/** @type {Vector} */ (n.slice(3))) };
    };
    const write = (/** @type {Vector} */ normal, /** @type {number} */ offset, /** @type {boolean} */ moving) =>
      this.#set_plane(index, [...scale(normal, offset), ...normal].map(digits).join(","), moving);
    const slider = element("input", {
      type: "range", min: 0, max: 1000, step: 1, "aria-label": `Place of clip plane ${index + 1}`,
      on_input: () => place(true), on_change: () => place(false),
    });
    const place = (/** @type {boolean} */ moving) => {
      const { normal } = read();
      const [low, high] = this.#span(normal);
      write(normal, low + (Number(slider.value) / 1000) * (high - low), moving);
    };
    const typed_place = typed(`Place of clip plane ${index + 1} along its direction`, (text) => {
      const offset = parsed_number(text);
      if (!Number.isFinite(offset)) return false;
      write(read().normal, offset, false);
      return true;
    }, { class: "short" });
    const direction = choice(`Direction of clip plane ${index + 1}`, (word) => {
      const { point } = read();
      const normal = word === "eye" ? scale(basis_of(this.page.camera).forward, -1) : normals[Number(word)]?.[1];
      if (normal) write(normal, dot(point, normal), false);
    }, [...normals.map(([text], i) => /** @type {[string, string]} */ ([String(i), text])), ["eye", "facing the camera"], ["own", "custom"]]);
    return element("div", { class: "row plane" }, direction, slider, typed_place, icon_button("trash", `Remove clip plane ${index + 1}`, () => this.#set_plane(index, undefined, false)));
  }

  /** @param {number} index @param {number[]} plane */
  #show_plane(index, plane) {
    const line = this.planes.children[index];
    const normal = unit(/** @type {Vector} */ (plane.slice(3)));
    const [low, high] = this.#span(normal);
    const slider = /** @type {HTMLInputElement} */ (line.querySelector("input"));
    const offset = dot(/** @type {Vector} */ (plane.slice(0, 3)), normal);
    show_value(/** @type {HTMLInputElement} */ (line.querySelector("input[type=text]")), short_number(offset, 5));
    slider.value = String(Math.round(((offset - low) / (high - low || 1)) * 1000));
    const known = normals.findIndex(([, n]) => dot(n, normal) > 1 - 1e-6);
    /** @type {HTMLSelectElement} */ (line.querySelector("select")).value = known < 0 ? "own" : String(known);
  }
}
