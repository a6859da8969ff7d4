// SPDX-License-Identifier: BSD-3-Clause
/**
 * The view, and the annotation of the picture.
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./types.js").Vector} Vector
 */
import { is_perspective, rolled, with_angle, with_projection } from "./camera.js";
import { hex_of } from "./colors.js";
import { button, checkbox, choice, element, icon_button, row, show_value, typed } from "./dom.js";
import { parsed_number, parsed_numbers, short_number } from "./numbers.js";

const views = ["front", "back", "left", "right", "top", "bottom", "iso"];

export class ViewPanel {
  /** @param {Page} page @param {{mode: () => string, set_mode: (mode: string) => void}} turning */
  constructor(page, turning) {
    this.page = page;
    this.turning = turning;
    const { history } = page;
    this.mode = choice("", (mode) => turning.set_mode(mode), [["turntable", "Turntable"], ["trackball", "Trackball"], ["fly", "Fly (W A S D Q E)"]]);
    this.projection = choice("", (word) => history.change({ camera: with_projection(page.camera, word === "perspective") }), [["orthographic", "Orthographic"], ["perspective", "Perspective"]]);
    this.angle = typed("View angle, degrees", (text) => {
      const angle = parsed_number(text);
      if (!(angle > 0 && angle < 180)) return false;
      history.change({ camera: with_angle(page.camera, angle) });
      return true;
    }, { class: "short" });
    const named = views.map((view) => button(view, () => void page.look(view), { "aria-label": `View from ${view === "iso" ? "a corner" : view}` }));
    const turn = (/** @type {number} */ degrees) => history.change({ camera: rolled(page.camera, (degrees * Math.PI) / 180) }, { name: "roll" });
    this.axes = choice("", (word) => page.set_option("axes", word === "none" ? undefined : word === "triad" ? true : word), [["none", "none"], ["triad", "directions"], ["box", "box"], ["both", "directions and box"]]);
    this.outline = checkbox("Outline", (on) => page.set_option("outline", on ? true : undefined), "The box of the data");
    this.scale_bar = checkbox("Scale bar", (on) => history.change({ "scale-bar": on ? page.switched_on("scale-bar") : page.unset("scale-bar") }));
    this.background = element("input", { type: "color", on_input: () => history.change({ background: this.background.value }, { moving: true }), on_change: () => history.change({ background: this.background.value }) });
    this.numbers = Object.fromEntries(["position", "focal_point", "view_up"].map((word) => [word, typed("", (text) => this.#type_vector(word, text))]));
    this.scale = typed("", (text) => this.#type_scale(text));
    this.element = element("div", { class: "panel-body" },
      row("Rotation", this.mode), row("Projection", this.projection, this.angle),
      element("div", { class: "buttons views", role: "group", "aria-label": "Named views" }, ...named,
        button("Fit", () => void page.look("fit"), { title: "All of the data, from the same side (F)" }), button("Default", () => void page.look("default"), { title: "The view that the page began with (R)" })),
      element("div", { class: "buttons" }, icon_button("roll-left", "Roll by 90° to the left", () => turn(-90)), icon_button("roll-right", "Roll by 90° to the right", () => turn(90))),
      element("div", { class: "heading" }, "In the image"),
      row("Axes", this.axes), element("div", { class: "checks" }, this.outline.label, this.scale_bar.label), row("Background", this.background),
      element("details", { class: "inner" }, element("summary", {}, "Camera values"), row("Position", this.numbers.position), row("Focal point", this.numbers.focal_point),
        row("Up", this.numbers.view_up), row("Parallel scale", this.scale)));
  }

  begin() {
    this.update();
  }

  update() {
    const { page } = this;
    const { camera } = page;
    this.mode.value = this.turning.mode();
    this.projection.value = is_perspective(camera) ? "perspective" : "orthographic";
    this.angle.hidden = !is_perspective(camera);
    show_value(this.angle, short_number(camera.view_angle, 4));
    const axes = page.option("axes");
    this.axes.value = !axes ? "none" : axes === true ? "triad" : axes;
    this.outline.input.checked = Boolean(page.option("outline"));
    this.scale_bar.input.checked = Boolean(page.option("scale-bar"));
    const background = hex_of(String(page.background ?? ""));
    if (background) show_value(this.background, background);
    for (const [word, input] of Object.entries(this.numbers))
      show_value(input, /** @type {Vector} */ (camera[/** @type {"position"} */ (word)]).map((v) => short_number(v, 6)).join(", "));
    const line = this.scale.parentElement;
    if (line) line.hidden = is_perspective(camera);
    show_value(this.scale, short_number(camera.parallel_scale, 6));
  }

  /** @param {string} word @param {string} text */
  #type_vector(word, text) {
    const vector = parsed_numbers(text, 3);
    if (!vector) return false;
    this.page.history.change({ camera: { ...this.page.camera, [word]: vector } });
    return true;
  }

  /** @param {string} text */
  #type_scale(text) {
    const scale = parsed_number(text);
    if (!(scale > 0)) return false;
    this.page.history.change({ camera: { ...this.page.camera, parallel_scale: scale } });
    return true;
  }
}
