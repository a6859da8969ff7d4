// SPDX-License-Identifier: BSD-3-Clause
/**
 * Iso-surfaces, the boundary, blocks and named surfaces of the mesh, lit, within the volume: options
 * "WHAT[:COLOUR[:OPACITY]]".
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {{what: string, color?: string, opacity: number}} Surface what: a value of the field, "boundary", the name of a block or of a surface
 */
import { hex_of } from "./colors.js";
import { button, checkbox, choice, element, icon_button, show_value, typed } from "./dom.js";
import { fraction_of, parsed_number, short_number } from "./numbers.js";
import { color_at, hex_color } from "./transfer_function.js";

/**
 * A name may contain colons, so the longest of `names` at the beginning of the word is its name. For any other word,
 * colour and opacity are recognised by their form.
 * @param {string} word @param {string[]} [names] @returns {Surface}
 */
export function parsed_surface(word, names = []) {
  const known = names.filter((name) => word === name || word.startsWith(`${name}:`)).sort((a, b) => b.length - a.length);
  for (const what of [...known, undefined]) {
    const rest = what === undefined ? word : word.slice(what.length);
    const found = what === undefined ? look.exec(rest) : bare_look.exec(rest);
    if (found) return { what: what ?? found.groups?.what ?? word, color: found.groups?.color, opacity: found.groups?.opacity === undefined ? 1 : Number(found.groups.opacity) };
  }
  return { what: word, opacity: 1 };
}
const colour_and_opacity = "(?::(?<color>#[0-9a-fA-F]{3,8}|[a-z]+|[0-9.eE+-]+(?:,[0-9.eE+-]+){2})?(?::(?<opacity>[0-9.eE-]+))?)?$";
const bare_look = new RegExp(`^${colour_and_opacity}`, "s"), look = new RegExp(`^(?<what>.*?)${colour_and_opacity}`, "s");

/** @param {Surface} surface */
export const surface_word = ({ what, color, opacity }) => `${what}${color !== undefined || opacity < 1 ? `:${color ?? ""}` : ""}${opacity < 1 ? `:${opacity}` : ""}`;

/** @param {any} value @param {string[]} names @returns {Surface[]} */
const listed = (value, names) => (value ? [value].flat().map((word) => parsed_surface(String(word), names)) : []);

/** The surfaces of one option, one per row. */
class SurfaceList {
  /**
   * @param {Page} page @param {"iso"|"surface"} option @param {(index: number, change: (what: string) => void) => HTMLInputElement | HTMLSelectElement} make_what
   * @param {(control: any, what: string) => void} show_what @param {(what: string) => string} own_color if none is given
   * @param {() => string[]} [names] of the existing blocks and surfaces
   */
  constructor(page, option, make_what, show_what, own_color, names = () => []) {
    this.page = page;
    this.option = option;
    this.make_what = make_what;
    this.show_what = show_what;
    this.own_color = own_color;
    this.names = names;
    this.element = element("div", { class: "group" });
  }

  get surfaces() {
    return listed(this.page.option(this.option), this.names());
  }

  /** @param {Surface[]} surfaces @param {boolean} moving */
  set(surfaces, moving) {
    this.page.history.change({ [this.option]: surfaces.length > 0 ? surfaces.map(surface_word) : this.page.unset(this.option) }, { moving, name: this.option });
  }

  /** @param {number} index @param {Partial<Surface> | undefined} change undefined: removed @param {boolean} moving */
  #change(index, change, moving) {
    const { surfaces } = this;
    if (!change) surfaces.splice(index, 1);
    else surfaces[index] = { ...surfaces[index], ...change };
    this.set(surfaces, moving);
  }

  update() {
    const { surfaces } = this;
    // The rows are not replaced while a slider is dragged.
    if (surfaces.length !== this.element.children.length) this.element.replaceChildren(...surfaces.map((_, i) => this.#row(i)));
    surfaces.forEach((surface, i) => {
      const [what, color, opacity] = this.element.children[i].querySelectorAll("input, select");
      this.show_what(what, surface.what);
      show_value(/** @type {HTMLInputElement} */ (color), (surface.color && hex_of(surface.color)) || this.own_color(surface.what));
      show_value(/** @type {HTMLInputElement} */ (opacity), String(surface.opacity));
    });
  }

  /** @param {number} index */
  #row(index) {
    const name = `${this.option === "iso" ? "iso-surface" : "surface"} ${index + 1}`;
    const what = this.make_what(index, (word) => this.#change(index, { what: word }, false));
    what.setAttribute("aria-label", this.option === "iso" ? `Value of ${name}` : `What ${name} is`);
    const recolor = (/** @type {boolean} */ moving) => this.#change(index, { color: color.value }, moving);
    const color = element("input", { type: "color", "aria-label": `Colour of ${name}`, on_input: () => recolor(true), on_change: () => recolor(false) });
    const fade = (/** @type {boolean} */ moving) => this.#change(index, { opacity: Number(opacity.value) }, moving);
    const opacity = element("input", { type: "range", min: 0.02, max: 1, step: 0.01, "aria-label": `Opacity of ${name}`, title: "Opacity", on_input: () => fade(true), on_change: () => fade(false) });
    return element("div", { class: "row surface" }, this.option === "iso" && element("span", { class: "label" }, "Iso"), what, color, opacity,
      icon_button("trash", `Remove ${name}`, () => this.#change(index, undefined, false)));
  }
}

export class SurfaceEditor {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.isos = new SurfaceList(page, "iso", (_, change) => typed("", (text) => {
      const number = parsed_number(text);
      if (Number.isNaN(number)) return false;
      change(String(number));
      return true;
    }), (input, what) => show_value(input, short_number(Number(what), 6)), (what) => this.#function_color(Number(what)));
    this.others = new SurfaceList(page, "surface", (_, change) => choice("", change, this.#names().map((name) => [name, name])),
      (select, what) => {
        // A file with which the server was started has no name in the data.
        if (![...select.options].some((option) => option.value === what)) select.append(element("option", { value: what }, what));
        select.value = what;
      }, () => "#cccccc", () => this.#names());
    this.shade = checkbox("Shade the volume", (on) => page.shade(on), "Lit by a light at the eye");
    this.add_other = button("Add a surface", () => this.#add_other(), { title: "The mesh's boundary, a surface that the file names, or a block" });
    this.unseen = element("p", { class: "warning", role: "status", hidden: true });
    this.element = element("div", { class: "surfaces" }, this.isos.element, this.unseen, this.others.element,
      element("div", { class: "buttons" }, button("Add an iso-surface", () => this.add()), this.add_other), element("div", { class: "checks" }, this.shade.label));
  }

  begin() {
    // Shading is for grids; the boundary and blocks are for meshes.
    const mesh = this.page.data.kind === "mesh";
    this.add_other.hidden = !mesh;
    this.shade.label.hidden = mesh;
  }

  #names() {
    return [...new Set(["boundary", ...(this.page.data?.surfaces ?? []), ...(this.page.data?.blocks ?? [])])];
  }

  /** Adds a surface at a value of the field. @param {number} [value] default: the middle of the function's range */
  add(value) {
    const range = this.page.edited_function()?.range ?? this.page.field_range;
    this.isos.set([...this.isos.surfaces, { what: String(Number((value ?? (range[0] + range[1]) / 2).toPrecision(6))), opacity: 1 }], false);
  }

  /** Adds the boundary, then the first surface or block that is not listed yet. */
  #add_other() {
    const there = this.others.surfaces;
    const what = this.#names().find((name) => !there.some((surface) => surface.what === name)) ?? "boundary";
    this.others.set([...there, { what, color: what === "boundary" ? "#ffffff" : "#cccccc", opacity: what === "boundary" ? 0.3 : 0.5 }], false);
  }

  /** Returns the colour of the transfer function at a value. @param {number} value */
  #function_color(value) {
    const edited = this.page.edited_function();
    return edited ? hex_color(color_at(edited, Math.max(0, Math.min(1, fraction_of(value, edited.range, edited.log))))) : "#cccccc";
  }

  /** Reports values that the field does not reach. A surface at its smallest value is not visible either. */
  #tell_unseen() {
    const { range } = this.page.data;
    const unseen = range ? this.isos.surfaces.map((surface) => Number(surface.what)).filter((value) => !(range[0] < value && value <= range[1])) : [];
    this.unseen.hidden = unseen.length === 0;
    const text = unseen.length === 0 || !range ? "" : `Nothing is seen at ${unseen.map((value) => short_number(value, 6)).join(", ")}: the field goes from ${short_number(range[0], 6)} to ${short_number(range[1], 6)}.`;
    // The text is set only when it changes, not with every update.
    if (this.unseen.textContent !== text) this.unseen.textContent = text;
  }

  update() {
    this.isos.update();
    this.#tell_unseen();
    this.others.update();
    this.shade.input.checked = this.page.is_shaded;
  }
}
