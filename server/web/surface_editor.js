/**
 * Iso-surfaces and the boundary, lit, within the volume: options "VALUE[:COLOUR[:OPACITY]]".
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {{value: string, color?: string, opacity: number}} Surface
 */
import { button, checkbox, element, icon_button, show_value, typed } from "./dom.js";
import { fraction_of, parsed_number, short_number } from "./numbers.js";
import { color_at, hex_color } from "./transfer_function.js";

/** @param {string} word @returns {Surface} */
export function parsed_surface(word) {
  const [value, color, opacity] = word.split(":");
  return { value, color: color || undefined, opacity: opacity === undefined ? 1 : Number(opacity) };
}

/** @param {Surface} surface */
export const surface_word = ({ value, color, opacity }) => (color === undefined ? value : `${value}:${color}${opacity < 1 ? `:${opacity}` : ""}`);

/** @param {any} value @returns {Surface[]} */
const listed = (value) => (value ? [value].flat().map((word) => parsed_surface(String(word))) : []);

export class SurfaceEditor {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.rows = element("div", { class: "group" });
    this.boundary_on = checkbox("Boundary surface", (on) => this.#set_boundary(on ? { value: "boundary", color: "#ffffff", opacity: 0.3 } : undefined, false), "The mesh's boundary, lit");
    this.boundary_color = element("input", { type: "color", "aria-label": "Colour of the boundary", on_input: () => this.#change_boundary(true), on_change: () => this.#change_boundary(false) });
    this.boundary_opacity = this.#opacity_slider("Opacity of the boundary", (moving) => this.#change_boundary(moving));
    this.boundary = element("div", { class: "row" }, this.boundary_color, this.boundary_opacity);
    this.shade = checkbox("Shade the volume", (on) => page.set_option("shade", on ? true : undefined), "Lit by a light at the eye");
    this.boundary_part = element("div", { class: "group" }, element("div", { class: "checks" }, this.boundary_on.label), this.boundary);
    this.element = element("div", { class: "surfaces" }, this.rows, element("div", { class: "buttons" }, button("Add an iso-surface", () => this.add())),
      this.boundary_part, element("div", { class: "checks" }, this.shade.label));
  }

  begin() {
    // Shade is of grids, the boundary of meshes.
    const mesh = this.page.data.kind === "mesh";
    this.boundary_part.hidden = !mesh;
    this.shade.label.hidden = mesh;
  }

  /** @param {string} label @param {(moving: boolean) => void} change */
  #opacity_slider(label, change) {
    return element("input", { type: "range", min: 0.02, max: 1, step: 0.01, "aria-label": label, title: label, on_input: () => change(true), on_change: () => change(false) });
  }

  get #surfaces() {
    return listed(this.page.option("iso"));
  }

  /** A surface at a value of the field. @param {number} [value] default: the middle of the function's range */
  add(value) {
    const edited = this.page.edited_function();
    const range = edited?.range ?? this.page.field_range;
    this.#set([...this.#surfaces, { value: String(Number((value ?? (range[0] + range[1]) / 2).toPrecision(6))), opacity: 1 }], false);
  }

  /** @param {Surface[]} surfaces @param {boolean} moving */
  #set(surfaces, moving) {
    this.page.history.change({ iso: surfaces.length > 0 ? surfaces.map(surface_word) : this.page.unset("iso") }, { moving, name: "iso" });
  }

  /** @param {number} index @param {Partial<Surface> | undefined} change @param {boolean} moving */
  #change(index, change, moving) {
    const surfaces = this.#surfaces;
    if (!change) surfaces.splice(index, 1);
    else {
      surfaces[index] = { ...surfaces[index], ...change };
      // An opacity is said behind a colour.
      if (surfaces[index].opacity < 1) surfaces[index].color ??= this.#own_color(Number(surfaces[index].value));
    }
    this.#set(surfaces, moving);
  }

  /** The transfer function's colour at a value. @param {number} value */
  #own_color(value) {
    const edited = this.page.edited_function();
    return edited ? hex_color(color_at(edited, Math.max(0, Math.min(1, fraction_of(value, edited.range, edited.log))))) : "#cccccc";
  }

  /** @param {Surface | undefined} surface @param {boolean} moving */
  #set_boundary(surface, moving) {
    this.page.history.change({ surface: surface ? [surface_word(surface)] : this.page.unset("surface") }, { moving, name: "surface" });
  }

  /** @param {boolean} moving */
  #change_boundary(moving) {
    this.#set_boundary({ value: "boundary", color: this.boundary_color.value, opacity: Number(this.boundary_opacity.value) }, moving);
  }

  update() {
    const surfaces = this.#surfaces;
    if (surfaces.length !== this.rows.children.length) this.rows.replaceChildren(...surfaces.map((_, i) => this.#row(i)));
    surfaces.forEach((surface, i) => {
      const [value, color, opacity] = /** @type {HTMLInputElement[]} */ ([...this.rows.children[i].querySelectorAll("input")]);
      show_value(value, short_number(Number(surface.value), 6));
      show_value(color, surface.color?.startsWith("#") ? surface.color : this.#own_color(Number(surface.value)));
      show_value(opacity, String(surface.opacity));
    });
    const [boundary] = listed(this.page.option("surface"));
    this.boundary_on.input.checked = Boolean(boundary);
    this.boundary.hidden = !boundary;
    if (boundary) {
      show_value(this.boundary_color, boundary.color?.startsWith("#") ? boundary.color : "#ffffff");
      show_value(this.boundary_opacity, String(boundary.opacity));
    }
    this.shade.input.checked = this.page.option("shade") === true;
  }

  /** @param {number} index */
  #row(index) {
    const name = `iso-surface ${index + 1}`;
    const value = typed(`Value of ${name}`, (text) => {
      const number = parsed_number(text);
      if (Number.isNaN(number)) return false;
      this.#change(index, { value: String(number) }, false);
      return true;
    });
    const recolor = (/** @type {boolean} */ moving) => this.#change(index, { color: color.value }, moving);
    const color = element("input", { type: "color", "aria-label": `Colour of ${name}`, on_input: () => recolor(true), on_change: () => recolor(false) });
    const opacity = this.#opacity_slider(`Opacity of ${name}`, (moving) => this.#change(index, { opacity: Number(opacity.value) }, moving));
    return element("div", { class: "row surface" }, element("span", { class: "label" }, "Iso"), value, color, opacity, icon_button("trash", `Remove ${name}`, () => this.#change(index, undefined, false)));
  }
}
