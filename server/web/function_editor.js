// SPDX-License-Identifier: BSD-3-Clause
/**
 * The transfer function as a drawing: the curve of opacity over the histogram, draggable points and colours, and two
 * handles for the range. It draws the arguments of show() and reports requested changes; it changes nothing itself.
 *
 * @typedef {import("./transfer_function.js").EditedFunction} EditedFunction
 * @typedef {import("./types.js").HistogramReply} HistogramReply
 * @typedef {{kind: "opacity"|"color", index: number}} Selection
 *
 * @typedef {object} Wishes
 * @property {(edited: EditedFunction, moving: boolean) => void} edit
 * @property {(range: [number, number], moving: boolean) => void} range
 * @property {() => void} cancel reverts a drag
 * @property {(selection: Selection | undefined) => void} select
 */
import { svg } from "./dom.js";
import { nearest_handle } from "./handles.js";
import { fraction_of, linear_ticks, log_ticks, opacity_at_height, opacity_height, short_number, value_of } from "./numbers.js";
import * as functions from "./transfer_function.js";

const margin = { left: 34, right: 10, top: 16, bottom: 54 };
const height = 250;
const strip_height = 16;
/** Usual size of the page's text, in CSS pixels. */
const usual_text = 14;

export class FunctionEditor {
  /** @param {Wishes} wishes */
  constructor(wishes) {
    this.wishes = wishes;
    /** @type {EditedFunction | undefined} */
    this.edited = undefined;
    /** @type {HistogramReply | undefined} */
    this.histogram = undefined;
    /** The range of values over the drawing's width. @type {[number, number]} */
    this.domain = [0, 1];
    /** Whether the drawing shows only the function's range instead of the field's. */
    this.close = false;
    this.log_opacity = false;
    /** @type {Selection | undefined} */
    this.selection = undefined;
    this.dragging = false;
    this.width = 320;
    this.element = svg("svg", {
      class: "function-editor", role: "group",
      "aria-label": "Transfer function: opacity over the field's value. Points are moved with the arrow keys, added with Enter, removed with Delete.",
      on_dblclick: (/** @type {MouseEvent} */ e) => this.#add(e), on_keydown: (/** @type {KeyboardEvent} */ e) => this.#key(e),
      on_pointerdown: (/** @type {PointerEvent} */ e) => this.#press(e),
    });
    // A finger on a handle moves it; elsewhere it scrolls the panel. `touch-action` does not work for parts of a drawing.
    this.element.addEventListener("touchstart", (event) => {
      if (event.touches.length === 1 && this.#handle_at(this.#place(event.touches[0]))) event.preventDefault();
    }, { passive: false });
    new ResizeObserver(() => {
      // The drawing's unit is a pixel at the page's usual text size, and grows with the text.
      const unit = Number.parseFloat(getComputedStyle(document.documentElement).fontSize) / usual_text;
      const width = Math.round(this.element.getBoundingClientRect().width / unit);
      if (width > 0 && width !== this.width) {
        this.width = width;
        this.draw();
      }
    }).observe(this.element);
  }

  /** @param {EditedFunction | undefined} edited @param {HistogramReply | undefined} histogram */
  show(edited, histogram) {
    this.edited = edited;
    this.histogram = histogram;
    if (!this.dragging) this.#choose_domain();
    const list = this.selection && edited && (this.selection.kind === "opacity" ? edited.opacities : edited.colors);
    if (this.selection && (!list || this.selection.index >= list.length)) this.select(undefined);
    this.draw();
  }

  #choose_domain() {
    if (!this.edited) return;
    let [low, high] = this.edited.range;
    if (!this.close && this.histogram) {
      low = Math.min(low, this.histogram.range[0]);
      high = Math.max(high, this.histogram.range[1]);
    }
    if (this.edited.log && !(low > 0)) low = this.edited.range[0] > 0 ? this.edited.range[0] : high * 1e-6;
    if (!(high > low)) high = low + (Math.abs(low) || 1) * 1e-6;
    this.domain = [low, high];
  }

  get plot_width() {
    return this.width - margin.left - margin.right;
  }
  get plot_height() {
    return height - margin.top - margin.bottom;
  }

  /** @param {number} value */
  x_of(value) {
    return margin.left + fraction_of(value, this.domain, this.edited?.log ?? false) * this.plot_width;
  }
  /** @param {number} x */
  value_at(x) {
    return value_of((x - margin.left) / this.plot_width, this.domain, this.edited?.log ?? false);
  }
  /** @param {number} opacity */
  y_of(opacity) {
    return margin.top + (1 - opacity_height(opacity, this.log_opacity)) * this.plot_height;
  }
  /** @param {number} y */
  opacity_at(y) {
    return opacity_at_height(1 - (y - margin.top) / this.plot_height, this.log_opacity);
  }
  /** A fraction of the function's range. @param {number} x */
  fraction_at(x) {
    const edited = /** @type {EditedFunction} */ (this.edited);
    return fraction_of(this.value_at(x), edited.range, edited.log);
  }

  /** @param {Selection | undefined} selection */
  select(selection) {
    this.selection = selection;
    this.wishes.select(selection);
  }

  draw() {
    const edited = this.edited;
    this.element.setAttribute("viewBox", `0 0 ${this.width} ${height}`);
    if (!edited) {
      this.element.replaceChildren(svg("text", { x: margin.left, y: height / 2, class: "tick" }, "…"));
      return;
    }
    const focused = document.activeElement instanceof SVGElement ? document.activeElement.getAttribute("data-handle") : null;
    const parts = [this.#definitions(edited), this.#grid(edited), this.#histogram_path(edited), ...this.#curve(edited), ...this.#outside(edited),
      ...this.#strip(edited), ...this.#points(edited), ...this.#range_handles(edited)];
    this.element.replaceChildren(...parts);
    if (focused) /** @type {SVGElement | null} */ (this.element.querySelector(`[data-handle="${focused}"]`))?.focus({ preventScroll: true });
  }

  /** @param {EditedFunction} edited */
  #definitions(edited) {
    const [low, high] = edited.range;
    const stops = edited.colors.map(([t, ...rgb]) => svg("stop", { offset: t, "stop-color": functions.hex_color(rgb) }));
    const gradient = svg("linearGradient", { id: "function-colors", gradientUnits: "userSpaceOnUse", x1: this.x_of(low), x2: this.x_of(high), y1: 0, y2: 0 }, ...stops);
    const clip = svg("clipPath", { id: "plot-area" }, svg("rect", { x: margin.left, y: 0, width: this.plot_width, height }));
    return svg("defs", {}, gradient, clip);
  }

  /** @param {EditedFunction} edited */
  #grid(edited) {
    const group = svg("g", { class: "grid", "aria-hidden": "true" });
    const foot = margin.top + this.plot_height;
    for (const opacity of this.log_opacity ? [0, 0.001, 0.01, 0.1, 1] : [0, 0.25, 0.5, 0.75, 1]) {
      const y = this.y_of(opacity);
      group.append(svg("line", { x1: margin.left, x2: this.width - margin.right, y1: y, y2: y }),
        svg("text", { x: margin.left - 4, y: y + 4, class: "tick", "text-anchor": "end" }, short_number(opacity)));
    }
    const count = Math.max(2, Math.floor(this.plot_width / 45));
    const ticks = edited.log ? log_ticks(...this.domain, count) : linear_ticks(...this.domain, count);
    for (const value of ticks) {
      const x = this.x_of(value);
      group.append(svg("line", { x1: x, x2: x, y1: foot + strip_height + 10, y2: foot + strip_height + 15 }),
        svg("text", { x, y: height - 12, class: "tick", "text-anchor": x > this.width - 25 ? "end" : "middle" }, short_number(value)));
    }
    return group;
  }

  /** @param {EditedFunction} edited */
  #histogram_path(edited) {
    const histogram = this.histogram;
    if (!histogram || histogram.counts.length === 0) return svg("g");
    const most = Math.max(...histogram.counts);
    const foot = margin.top + this.plot_height, count = histogram.counts.length;
    // A share of 1 in 10 000 of the fullest bin remains visible.
    const tall = (/** @type {number} */ share) => (most > 0 ? Math.log1p((share / most) * 1e4) / Math.log1p(1e4) : 0) * this.plot_height;
    let path = `M${this.x_of(histogram.range[0]).toFixed(1)} ${foot}`;
    histogram.counts.forEach((share, i) => {
      const ends = [i, i + 1].map((k) => this.x_of(value_of(k / count, histogram.range, histogram.log)));
      if (!ends.every(Number.isFinite)) return;
      const y = (foot - tall(share)).toFixed(1);
      path += `L${ends[0].toFixed(1)} ${y}L${ends[1].toFixed(1)} ${y}`;
    });
    path += `L${this.x_of(histogram.range[1]).toFixed(1)} ${foot}Z`;
    const made = svg("path", { class: "histogram", d: path, "clip-path": "url(#plot-area)" });
    made.append(svg("title", {}, `How the volume's values are distributed${edited.log ? ", over their logarithm" : ""}; heights are logarithmic`));
    return made;
  }

  /** @param {EditedFunction} edited */
  #curve(edited) {
    const foot = margin.top + this.plot_height;
    const [left, right] = edited.range.map((v) => this.x_of(v));
    /** @type {[number, number][]} */
    const places = [];
    // Straight lines between opacities are curves on a logarithmic axis, so they are drawn in pieces.
    edited.opacities.forEach(([t, opacity], i) => {
      const next = edited.opacities[i + 1];
      const pieces = next && this.log_opacity ? 24 : 1;
      for (let k = 0; k < pieces; ++k) {
        const f = k / pieces;
        const [u, a] = f > 0 && next ? [t + f * (next[0] - t), opacity + f * (next[1] - opacity)] : [t, opacity];
        places.push([left + u * (right - left), this.y_of(a)]);
      }
    });
    const inside = places.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L");
    const first = places[0][1].toFixed(1), last = places[places.length - 1][1].toFixed(1);
    const ends = [margin.left, this.width - margin.right];
    return [
      svg("path", { class: "under", d: `M${left.toFixed(1)} ${foot}L${inside}L${right.toFixed(1)} ${foot}Z`, fill: "url(#function-colors)", "clip-path": "url(#plot-area)" }),
      svg("path", { class: "beyond", d: `M${ends[0]} ${first}L${left.toFixed(1)} ${first}M${right.toFixed(1)} ${last}L${ends[1]} ${last}`, "clip-path": "url(#plot-area)" }),
      svg("path", { class: "curve", d: `M${inside}`, "clip-path": "url(#plot-area)" }),
    ];
  }

  /** @param {EditedFunction} edited */
  #outside(edited) {
    const [left, right] = edited.range.map((v) => this.#inside(this.x_of(v)));
    const shade = (/** @type {number} */ from, /** @type {number} */ to) =>
      svg("rect", { class: "outside", x: from, y: margin.top, width: Math.max(0, to - from), height: this.plot_height });
    return [shade(margin.left, left), shade(right, this.width - margin.right)];
  }

  /** @param {EditedFunction} edited */
  #strip(edited) {
    const y = margin.top + this.plot_height + 6;
    const strip = svg("rect", { class: "strip", x: margin.left, y, width: this.plot_width, height: strip_height, fill: "url(#function-colors)" });
    strip.append(svg("title", {}, "Colours; double-click adds one"));
    return [strip, ...edited.colors.map(([t, ...rgb], index) => {
      const x = this.x_of(functions.value_at(edited, t));
      if (edited.colors.length > functions.most_handles && !this.#selected("color", index)) return svg("g");
      if (x < margin.left - 1 || x > this.width - margin.right + 1) return svg("g");
      const handle = svg("path", {
        d: `M${x} ${y + strip_height - 5}l5 8v5h-10v-5z`, fill: functions.hex_color(rgb), class: this.#handle_class("color", index),
        tabindex: 0, role: "slider", "data-handle": `color-${index}`,
        "aria-label": `Colour ${index + 1} of ${edited.colors.length}`, "aria-valuenow": functions.value_at(edited, t),
        "aria-valuetext": `${functions.hex_color(rgb)} at ${short_number(functions.value_at(edited, t))}`,
        on_focus: () => this.#selected("color", index) || (this.select({ kind: "color", index }), this.draw()),
      });
      return handle;
    })];
  }

  /** @param {EditedFunction} edited */
  #points(edited) {
    return edited.opacities.map(([t, opacity], index) => {
      const value = functions.value_at(edited, t);
      const [x, y] = [this.x_of(value), this.y_of(opacity)];
      const group = svg("g", {
        class: this.#handle_class("opacity", index), tabindex: 0, role: "slider", "data-handle": `opacity-${index}`,
        transform: `translate(${x.toFixed(2)} ${y.toFixed(2)})`, "aria-label": `Point ${index + 1} of ${edited.opacities.length}`,
        "aria-valuemin": 0, "aria-valuemax": 1, "aria-valuenow": opacity, "aria-valuetext": `opacity ${short_number(opacity)} at ${short_number(value)}`,
        on_focus: () => this.#selected("opacity", index) || (this.select({ kind: "opacity", index }), this.draw()),
      }, svg("circle", { r: 13, class: "reach" }), svg("circle", { r: 6, class: "dot", fill: functions.hex_color(functions.color_at(edited, t)) }));
      return group;
    });
  }

  /** @param {EditedFunction} edited */
  #range_handles(edited) {
    return edited.range.map((value, end) => {
      const x = this.#inside(this.x_of(value));
      const group = svg("g", {
        class: "range-handle", tabindex: 0, role: "slider", "data-handle": `range-${end}`, transform: `translate(${x.toFixed(2)} 0)`,
        "aria-label": end === 0 ? "Low end of the range" : "High end of the range", "aria-valuenow": value, "aria-valuetext": short_number(value),
      }, svg("line", { y1: 10, y2: margin.top + this.plot_height }), svg("path", { d: end === 0 ? "M0 1h9v8h-3l-6 6z" : "M0 1h-9v8h3l6 6z" }),
      svg("rect", { x: end === 0 ? -4 : -14, y: -2, width: 18, height: 20, class: "reach" }));
      return group;
    });
  }

  /** @param {"opacity"|"color"} kind @param {number} index */
  #selected(kind, index) {
    return this.selection?.kind === kind && this.selection.index === index;
  }
  /** @param {"opacity"|"color"} kind @param {number} index */
  #handle_class(kind, index) {
    return `${kind}-handle${this.#selected(kind, index) ? " selected" : ""}`;
  }

  /** The position of an event in the drawing. @param {{clientX: number, clientY: number}} event */
  #place(event) {
    const box = this.element.getBoundingClientRect();
    return { x: ((event.clientX - box.left) / box.width) * this.width, y: ((event.clientY - box.top) / box.height) * height };
  }

  /** All handles with their positions in the drawing. @returns {import("./handles.js").Handle[]} */
  #handles() {
    const { edited } = this;
    if (!edited) return [];
    const foot = margin.top + this.plot_height;
    const points = edited.opacities.map(([t, opacity], i) => ({ name: `opacity-${i}`, x: this.x_of(functions.value_at(edited, t)), y: this.y_of(opacity), reach: 13 }));
    const colors = edited.colors.map(([t], i) => ({ name: `color-${i}`, x: this.x_of(functions.value_at(edited, t)), y: foot + strip_height + 24, reach: 9 }));
    const ends = edited.range.flatMap((value, end) => {
      const x = this.#inside(this.x_of(value)), name = `range-${end}`;
      return [{ name, x: x + (end === 0 ? 5 : -5), y: 6, reach: 13 }, { name, x, y: 10, foot, reach: 4, behind: 6 }];
    });
    return [...points, ...colors, ...ends].filter(({ name }) => this.element.querySelector(`[data-handle="${name}"]`));
  }

  /** @param {number} x */
  #inside(x) {
    return Math.max(margin.left, Math.min(this.width - margin.right, x));
  }

  /** @param {{x: number, y: number}} place */
  #handle_at(place) {
    const selected = this.selection && `${this.selection.kind}-${this.selection.index}`;
    return nearest_handle(this.#handles(), place, selected)?.name;
  }

  /** @param {PointerEvent} event */
  #press(event) {
    const name = event.button === 0 && !this.dragging && this.#handle_at(this.#place(event));
    if (!name) return;
    event.preventDefault();
    event.stopPropagation();
    const [kind, number] = name.split("-");
    const index = Number(number);
    if (kind === "opacity" || kind === "color") this.select({ kind, index });
    const show = () => {
      this.draw();
      /** @type {SVGElement | null} */ (this.element.querySelector(`[data-handle="${name}"]`))?.focus({ preventScroll: true });
    };
    // A finger's touchstart comes later, for the pressed element, which a redrawn drawing would no longer contain.
    if (event.pointerType !== "touch") show();
    this.#follow(event, show, (place, moving) => this.#pull(kind, index, place, moving));
  }

  /**
   * Follows a pressed pointer across redraws.
   * @param {PointerEvent} pressed @param {() => void} show selects the handle
   * @param {(place: {x: number, y: number}, moving: boolean) => void} follow
   */
  #follow(pressed, show, follow) {
    const begun = this.edited;
    this.dragging = true;
    let moved = false;
    const move = (/** @type {PointerEvent} */ e) => {
      if (e.pointerId !== pressed.pointerId || (!moved && Math.hypot(e.clientX - pressed.clientX, e.clientY - pressed.clientY) < 2)) return;
      if (!moved) show();
      moved = true;
      follow(this.#place(e), true);
    };
    const end = (/** @type {PointerEvent} */ e) => {
      if (e.pointerId !== pressed.pointerId) return;
      window.removeEventListener("pointermove", move);
      window.removeEventListener("pointerup", end);
      window.removeEventListener("pointercancel", end);
      this.dragging = false;
      if (!moved && e.type === "pointerup") show();
      // A drag cancelled by the browser has no final position.
      if (moved && e.type === "pointercancel") {
        this.edited = begun;
        this.wishes.cancel();
      } else if (moved) {
        follow(this.#place(e), false);
      }
      this.#choose_domain();
      this.draw();
    };
    window.addEventListener("pointermove", move);
    window.addEventListener("pointerup", end);
    window.addEventListener("pointercancel", end);
  }

  /** Moves a handle to a position. @param {string} kind @param {number} index @param {{x: number, y: number}} place @param {boolean} moving */
  #pull(kind, index, { x, y }, moving) {
    if (!this.edited) return;
    if (kind === "range") return this.#move_end(index, this.value_at(this.#inside(x)), moving);
    const t = this.fraction_at(x);
    this.#edit(kind === "opacity" ? functions.with_opacity(this.edited, index, t, this.opacity_at(y))
      : functions.with_color(this.edited, index, t, this.edited.colors[index].slice(1)), moving);
  }

  /** @param {number} end @param {number} value @param {boolean} moving */
  #move_end(end, value, moving) {
    if (!this.edited) return;
    const range = /** @type {[number, number]} */ ([...this.edited.range]);
    range[end] = Number(value.toPrecision(6));
    const least = 1e-6 * (this.domain[1] - this.domain[0]);
    if (!(range[1] - range[0] > least)) return;
    this.edited = { ...this.edited, range };
    this.draw();
    this.wishes.range(range, moving);
  }

  /** @param {EditedFunction} edited @param {boolean} moving */
  #edit(edited, moving) {
    this.edited = edited;
    this.draw();
    this.wishes.edit(edited, moving);
  }

  /** Adds a point at a position of the drawing, or a colour on its strip. @param {MouseEvent} event */
  #add(event) {
    const { x, y } = this.#place(event);
    if (!this.edited || this.#handle_at({ x, y })) return;
    const t = this.fraction_at(x);
    if (!(t > 0 && t < 1)) return;
    if (y > margin.top + this.plot_height + 3) this.add_color(t);
    else this.add_point(t, this.opacity_at(y));
  }

  /** @param {number} t @param {number} [opacity] default: the curve's */
  add_point(t, opacity) {
    if (!this.edited) return;
    const { edited, index } = functions.with_point(this.edited, t, opacity);
    this.select({ kind: "opacity", index });
    this.#edit(edited, false);
    /** @type {SVGElement | null} */ (this.element.querySelector(`[data-handle="opacity-${index}"]`))?.focus();
  }

  /** @param {number} t */
  add_color(t) {
    if (!this.edited) return;
    const { edited, index } = functions.with_color_point(this.edited, t);
    this.select({ kind: "color", index });
    this.#edit(edited, false);
  }

  /** Removes the selected point or colour, unless it is at an end. */
  remove() {
    if (!this.edited || !this.selection) return;
    const { kind, index } = this.selection;
    const edited = kind === "opacity" ? functions.without_point(this.edited, index) : functions.without_color(this.edited, index);
    if (edited === this.edited) return;
    this.select({ kind, index: index - 1 });
    this.#edit(edited, false);
    /** @type {SVGElement | null} */ (this.element.querySelector(`[data-handle="${kind}-${index - 1}"]`))?.focus();
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const handle = event.target instanceof Element ? event.target.closest("[data-handle]")?.getAttribute("data-handle") : null;
    if (!handle || !this.edited || event.ctrlKey || event.metaKey || event.altKey) return;
    const [kind, number] = handle.split("-");
    const index = Number(number);
    const step = event.shiftKey ? 0.002 : 0.02;
    const along = { ArrowLeft: -step, ArrowRight: step }[event.key] ?? 0, up = { ArrowUp: step, ArrowDown: -step }[event.key] ?? 0;
    if (along || up) this.#nudge(kind, index, along, up);
    else if ((event.key === "Delete" || event.key === "Backspace") && kind !== "range") this.remove();
    else if (event.key === "Enter" && kind !== "range") this.#add_after(kind, index);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {string} kind @param {number} index @param {number} along fraction of the drawing's width @param {number} up of its height */
  #nudge(kind, index, along, up) {
    const edited = /** @type {EditedFunction} */ (this.edited);
    if (kind === "range") {
      const x = this.x_of(edited.range[index]) + (along + up) * this.plot_width;
      return this.#move_end(index, this.value_at(x), false);
    }
    const list = kind === "opacity" ? edited.opacities : edited.colors;
    const [t, opacity] = list[index];
    const to = this.fraction_at(this.x_of(functions.value_at(edited, t)) + along * this.plot_width);
    const next = along ? to : t;
    if (kind === "color") return this.#edit(functions.with_color(edited, index, next, edited.colors[index].slice(1)), false);
    const tall = up ? opacity_at_height(opacity_height(opacity, this.log_opacity) + up, this.log_opacity) : opacity;
    this.#edit(functions.with_opacity(edited, index, next, tall), false);
  }

  /** @param {string} kind @param {number} index */
  #add_after(kind, index) {
    const edited = /** @type {EditedFunction} */ (this.edited);
    const list = kind === "opacity" ? edited.opacities : edited.colors;
    const other = index + 1 < list.length ? index + 1 : index - 1;
    const t = (list[index][0] + list[other][0]) / 2;
    if (kind === "opacity") this.add_point(t);
    else this.add_color(t);
  }
}
