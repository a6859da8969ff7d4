// SPDX-License-Identifier: BSD-3-Clause
/**
 * Selection of the data to draw: field (at the top of the panel), time, blocks, cuts, surfaces.
 *
 * @typedef {import("./page.js").Page} Page
 */
import { button, checkbox, choice, element, fill_choice, icon, icon_button, row, show_value, typed } from "./dom.js";
import { ClipEditor } from "./clip_editor.js";
import { DoubleSlider } from "./double_slider.js";
import { field_named, field_words, split_field } from "./fields.js";
import { parsed_number, short_number } from "./numbers.js";
import { SurfaceEditor } from "./surface_editor.js";

/** Shortest time in milliseconds for which a step is shown while playing. */
const step_time = 100;

export class DataPanel {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.playing = false;
    this.play_timer = 0;
    this.last_step = 0;
    this.field = choice("", (name) => this.#choose_field(name));
    this.part = choice("Component", (part) => this.#choose_part(part));
    // The field is at the top of the panel, since the choice of data precedes their appearance.
    this.field_row = row("Field", this.field, this.part);
    this.field_row.classList.add("panel-top");
    this.smooth = checkbox("Smooth", (on) => page.set_option("smooth", on ? true : undefined), "Average cell values to the points");
    this.step = element("input", { type: "range", min: 0, step: 1, "aria-label": "Time step", on_input: () => this.#set_step(Number(this.step.value), true), on_change: () => page.history.settle("step") });
    this.step_text = typed("Time step", (text) => this.#type_step(text), { class: "short" });
    this.play = icon_button("play", "Play the time steps (space)", () => this.toggle_play());
    this.time_text = element("span", { class: "hint" });
    this.time = element("div", { class: "group", hidden: true }, row("Time step", this.step, this.step_text, this.play), this.time_text);
    this.blocks = element("fieldset", { class: "blocks", hidden: true });
    this.threshold_on = checkbox("Threshold", (on) => page.set_option("threshold", on ? this.page.field_range.join(",") : undefined), "Keep whole cells whose values are all in this range");
    this.threshold = new DoubleSlider("Values", (ends, moving) => page.history.change({ threshold: ends.join(",") }, { moving, name: "threshold" }));
    this.clip = new ClipEditor(page);
    this.surfaces = new SurfaceEditor(page);
    this.element = element("div", { class: "panel-body" },
      element("div", { class: "checks" }, this.smooth.label), this.time, this.blocks,
      element("div", { class: "checks" }, this.threshold_on.label), this.threshold.element, this.clip.element, this.surfaces.element);
  }

  begin() {
    const { data } = this.page;
    const words = field_words(data.fields);
    const fields = data.fields.map((f, i) => /** @type {[string, string]} */ ([words[i], `${f.name} (${f.association}${f.components > 1 ? `, ${f.components} components` : ""})`]));
    // A file without a meaningful field is shown as a shape, until a field is chosen.
    fill_choice(this.field, data.field === null ? [["", "none (draw the shape)"], ...fields] : fields);
    this.field_row.hidden = data.fields.length === 0;
    this.smooth.label.hidden = !data.fields.some((f) => f.association === "cell");
    this.#begin_blocks();
    const count = this.step_count;
    this.time.hidden = count < 2;
    this.step.max = String(Math.max(0, count - 1));
    this.clip.begin();
    this.surfaces.begin();
    this.update();
  }

  get step_count() {
    return this.page.data.time_steps ?? this.page.data.times?.length ?? 1;
  }

  #begin_blocks() {
    const names = this.page.data.blocks ?? [];
    this.blocks.hidden = names.length < 2;
    this.block_boxes = names.map((name) => ({ name, ...checkbox(name, () => this.#set_blocks()) }));
    this.blocks.replaceChildren(element("legend", {}, "Blocks"), ...this.block_boxes.map((b) => b.label),
      element("div", { class: "buttons" }, button("All", () => this.page.set_option("block", undefined))));
  }

  #set_blocks() {
    const chosen = (this.block_boxes ?? []).filter((b) => b.input.checked).map((b) => b.name);
    if (chosen.length === 0) {
      this.page.messages.tell("At least one block has to be drawn.");
      this.update();
      return;
    }
    this.page.set_option("block", chosen.length === this.block_boxes?.length ? undefined : chosen);
  }

  update() {
    const { page } = this;
    const [name, part] = this.#field_words();
    this.field.value = name;
    const found = field_named(name, page.data.fields);
    const components = found?.components ?? 1;
    this.part.hidden = components < 2;
    const letters = components <= 3 ? ["x", "y", "z"].slice(0, components) : Array.from({ length: components }, (_, i) => String(i));
    fill_choice(this.part, [["mag", "length"], ...letters.map((w) => /** @type {[string, string]} */ ([w, w]))]);
    this.part.value = part || "mag";
    this.smooth.input.checked = page.option("smooth") === true;
    this.smooth.input.disabled = found?.association === "point" && !this.smooth.input.checked;
    const step = this.current_step;
    show_value(this.step, String(step));
    show_value(this.step_text, String(step));
    const time = page.data.times?.[step];
    this.time_text.textContent = time === undefined ? "" : `Time ${short_number(time, 6)}, step ${step} of ${this.step_count - 1}`;
    const blocks = page.option("block");
    for (const box of this.block_boxes ?? []) box.input.checked = !blocks || [blocks].flat().includes(box.name);
    const threshold = page.option("threshold");
    this.threshold_on.input.checked = Boolean(threshold);
    this.threshold.element.hidden = !threshold;
    const ends = /** @type {[number, number]} */ (threshold ? String(threshold).split(",").map(Number) : page.field_range);
    this.threshold.show(page.field_range, ends);
    this.clip.update();
    this.surfaces.update();
  }

  /** The field's name in the form of options, and its component. @returns {[string, string]} */
  #field_words() {
    const { page } = this;
    return split_field(String(page.option("field") ?? page.data.field ?? ""), field_words(page.data.fields));
  }

  /** @param {string} name */
  #choose_field(name) {
    if (name === "") return this.page.set_field(undefined);
    const components = field_named(name, this.page.data.fields)?.components ?? 1;
    this.page.set_field(components > 1 ? `${name}:mag` : name);
  }

  /** @param {string} part */
  #choose_part(part) {
    this.page.set_field(`${this.field.value}:${part}`);
  }

  get current_step() {
    return Number(this.page.option("time-step") ?? this.step_count - 1);
  }

  /** @param {number} step @param {boolean} moving */
  #set_step(step, moving) {
    this.page.history.change({ "time-step": String(step) }, { moving, name: "step" });
  }

  /** @param {string} text */
  #type_step(text) {
    const step = parsed_number(text);
    if (!Number.isInteger(step) || step < 0 || step >= this.step_count) return false;
    this.#set_step(step, false);
    return true;
  }

  /** Moves by a number of time steps, cyclically. @param {number} by */
  step_by(by) {
    if (this.step_count < 2) return;
    this.#set_step((this.current_step + by + this.step_count) % this.step_count, this.playing);
  }

  toggle_play() {
    if (this.step_count < 2) return;
    this.playing = !this.playing;
    this.play.replaceChildren(icon(this.playing ? "pause" : "play"));
    this.play.setAttribute("aria-pressed", String(this.playing));
    clearTimeout(this.play_timer);
    if (this.playing) this.step_by(1);
    else this.page.history.settle("play");
  }

  /** Must be called when a frame has been painted, so that the next step may follow. */
  painted() {
    if (!this.playing) return;
    clearTimeout(this.play_timer);
    const wait = Math.max(0, this.last_step + step_time - performance.now());
    this.play_timer = window.setTimeout(() => {
      this.last_step = performance.now();
      if (this.playing) this.step_by(1);
    }, wait);
  }

  /** Ends playing. Must be called after an error. */
  stop() {
    if (this.playing) this.toggle_play();
  }
}
