// SPDX-License-Identifier: BSD-3-Clause
/**
 * Colour and opacity: presets, the editor, range, and ParaView's files.
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./types.js").FunctionReply} FunctionReply
 * @typedef {import("./types.js").Preset} Preset
 * @typedef {import("./transfer_function.js").EditedFunction} EditedFunction
 */
import { button, checkbox, choice, debounced, element, fill_choice, icon_button, preference, row, set_preference, show_value, typed } from "./dom.js";
import { FunctionEditor } from "./function_editor.js";
import { fraction_of, parsed_number, short_number } from "./numbers.js";
import { ask_about, LatestQuestion } from "./requests.js";
import { same } from "./state.js";
import * as functions from "./transfer_function.js";
import { in_page_words, sentence_of } from "./wording.js";

/** The options on which a function depends, and those on which its histogram depends. */
const data_words = ["field", "time-step", "block", "smooth"];
const function_words = [...data_words, "threshold", "clip", "transfer-function", "range", "log", "opacity", "unit-distance"];
const histogram_words = [...data_words, "threshold", "clip", "log"];

/** The name of the colours at the beginning of a function's name. @param {string | undefined} name */
const preset_of = (name) => /^[\w-]+(?=$|[ :])/.exec(name ?? "")?.[0];

/** A point with the precision of those that the server returns. @param {number[]} point */
const rounded = (point) => point.map((v) => Number(v.toPrecision(6)));

export class FunctionPanel {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.function_question = new LatestQuestion();
    this.histogram_question = new LatestQuestion();
    this.function_key = "";
    /** Key of the reply that is shown. */
    this.taken_key = "";
    this.histogram_key = "";
    /** @type {FunctionReply | undefined} */
    this.reply = undefined;
    /** @type {import("./types.js").HistogramReply | undefined} */
    this.histogram = undefined;
    /** The last chosen shape, and its points: its name is shown until they are edited. @type {{ name: string, opacities: number[][] } | undefined} */
    this.chosen_shape = undefined;
    this.editor = new FunctionEditor({
      edit: (edited, moving) => this.#edit(edited, moving),
      range: (range, moving) => this.#set_range(range, moving),
      cancel: () => this.#cancel(),
      select: () => this.#show_selection(),
    });
    this.editor.log_opacity = preference("log-opacity", "no") === "yes";
    this.element = element("div", { class: "panel-body" });
    this.refresh = debounced(() => void this.#refresh(), 60);

    this.swatches = element("div", { class: "swatches", role: "group", "aria-label": "Colours" });
    this.shape = choice("", (word) => void this.#choose(undefined, word));
    const log_axis = checkbox("Log opacity axis", (on) => {
      this.editor.log_opacity = on;
      set_preference("log-opacity", on ? "yes" : "no");
      this.editor.draw();
    }, "Room for opacities near zero");
    log_axis.input.checked = this.editor.log_opacity;
    const close = checkbox("Zoom to range", (on) => {
      this.editor.close = on;
      this.editor.show(this.editor.edited, this.histogram);
    }, "Draw the function's range alone, not the whole field");
    this.log = checkbox("Log values", (on) => this.#set_log(on), "Colours and opacities by the logarithm of the value");

    this.point_value = typed("Value of the point", (text) => this.#type_point(text, undefined));
    this.point_opacity = typed("Opacity of the point, per unit distance", (text) => this.#type_point(undefined, text));
    this.point_color = element("input", {
      type: "color", "aria-label": "Colour at the point", title: "Colour at the point",
      on_input: () => this.#color_point(true), on_change: () => this.#color_point(false),
    });
    const add = icon_button("plus", "Add a point at the middle of the widest gap", () => this.#add_in_gap());
    this.remove = icon_button("trash", "Remove the point (Delete)", () => this.editor.remove());
    this.point_row = element("div", { class: "row point-row" }, this.point_value, this.point_opacity, this.point_color, add, this.remove);

    this.curve = element("div", { class: "curve-row" }, this.editor.element, this.point_row);

    this.few = button("Edit colours", () => this.editor.edited && this.#edit(functions.with_few_colors(this.editor.edited), false),
      { title: "Keep the few colours that matter most, each with a handle on the bar" });

    this.low = typed("Low end of the range", (text) => this.#type_range(text, undefined));
    this.high = typed("High end of the range", (text) => this.#type_range(undefined, text));
    const ranges = element("div", { class: "buttons" },
      button("Full range", () => this.#range_of("whole"), { title: "Range: all of the field's values" }),
      button("Middle 99 %", () => this.#range_of("most"), { title: "Range: the values of 99 % of the volume" }),
      button("In view", () => this.#range_of("visible"), { title: "Range: the values of 99 % of what this view shows" }),
      button("Reset", () => this.page.history.change({ range: undefined, "transfer-function": undefined, log: undefined, opacity: undefined, "unit-distance": undefined, "color-bar-scale": undefined }),
        { title: "The function that the server chooses" }));

    this.strength = element("input", {
      type: "range", min: -2, max: 2, step: 0.01, on_input: () => this.#set_strength(true), on_change: () => this.#set_strength(false),
    });
    this.strength_text = typed("Overall opacity, a factor", (text) => this.#type_strength(text), { class: "short" });
    this.distance = typed("", (text) => this.#type_distance(text), { title: "Unit distance: the world length over which an opacity holds" });
    this.bar = checkbox("Colour bar", (on) => this.#set_bar(on), "Drawn in the image, and in saved ones");
    this.bar_title = typed("", (text) => this.page.history.change({ "color-bar-title": text.trim() || this.page.unset("color-bar-title") }),
      { inputmode: "text", placeholder: "the field's name", title: "{field}, {time}, {file}, {min} and {max} are filled in" });
    this.bar_row = row("Bar's title", this.bar_title);
    this.warning = element("p", { class: "warning", role: "status", hidden: true });

    const file = element("input", { type: "file", accept: ".json,application/json", hidden: true, on_change: () => void this.#import() });
    this.file = file;
    this.element.append(
      this.swatches,
      element("div", { class: "row" }, element("label", { for: "shape" }, "Shape"), this.shape, icon_button("swap", "Reverse the colours", () => this.#reverse())),
      this.curve,
      element("div", { class: "checks" }, log_axis.label, this.log.label, close.label, this.few), this.warning,
      element("div", { class: "row" }, element("span", { class: "label" }, "Range"), this.low, this.high), ranges,
      row("Opacity scale", this.strength, this.strength_text), row("Unit distance", this.distance),
      element("div", { class: "checks" }, this.bar.label), this.bar_row,
      element("div", { class: "buttons" }, button("Import…", () => file.click(), { title: "A colour map of ParaView's, .json" }),
        button("Export", () => this.#export(), { title: "As ParaView's colour map, .json" })), file);
    this.shape.id = "shape";
    this.#show_selection();
  }

  /** Adds the presets once they are known. */
  begin() {
    const { presets, opacities } = this.page.data;
    this.swatches.replaceChildren(...presets.map((preset) => {
      const bar = element("span", { class: "gradient", "aria-hidden": "true" });
      bar.style.backgroundImage = `linear-gradient(to right, ${preset.colors.join(", ")})`;
      return element("button", {
        type: "button", class: "swatch", "data-preset": preset.name, title: preset.name, "aria-pressed": "false",
        on_click: () => void this.#choose(preset.name, undefined),
      }, bar, element("span", {}, preset.name));
    }));
    fill_choice(this.shape, [["", "custom"], ...opacities.map((name) => /** @type {[string, string]} */ ([name, name]))]);
    // It only describes the present curve and cannot be chosen.
    this.shape.options[0].disabled = true;
    this.update();
  }

  /** Must be called when the state or the data have changed. */
  update() {
    const { page } = this;
    this.log.input.checked = page.option("log") === true;
    this.bar.input.checked = Boolean(page.option("color-bar"));
    this.bar_row.hidden = !this.bar.input.checked;
    show_value(this.bar_title, String(page.option("color-bar-title") ?? ""));
    const strength = Number(page.option("opacity") ?? 1);
    show_value(this.strength, String(Math.log10(strength)));
    show_value(this.strength_text, short_number(strength, 3));
    this.refresh();
  }

  /** Whether the panel shows the server's answer to the present state. */
  get is_answered() {
    return this.taken_key === this.#key(function_words) && this.histogram_key === this.#key(histogram_words) && !this.histogram_question.running;
  }

  /** @param {string[]} words */
  #key(words) {
    return JSON.stringify(words.map((word) => this.page.history.state[word] ?? null));
  }

  async #refresh() {
    if (this.page.history.moving || !this.page.ready) return;
    const histogram_key = this.#key(histogram_words), function_key = this.#key(function_words);
    const work = [];
    if (histogram_key !== this.histogram_key) {
      this.histogram_key = histogram_key;
      work.push(this.histogram_question.ask("api/histogram", { state: this.page.full_state(), bins: 256, visible: false })
        .then((reply) => { if (reply) this.histogram = reply; }).catch(() => { this.histogram_key = ""; }));
    }
    if (function_key !== this.function_key) {
      this.function_key = function_key;
      work.push(this.function_question.ask("api/function", { state: this.page.full_state() })
        .then((reply) => {
          if (!reply || function_key !== this.#key(function_words)) return;
          this.taken_key = function_key;
          this.#hold(false);
          this.#take(reply);
        }).catch(() => {
          this.function_key = "";
          this.#hold(false);
        }));
    } else if (function_key === this.taken_key) {
      this.#hold(false); // the choice was undone before a request
    }
    if (work.length === 0) return;
    await Promise.all(work);
    this.editor.show(this.editor.edited, this.histogram);
  }

  /** Whether the curve waits for the server; the control that was used keeps the focus. @param {boolean} on */
  #hold(on) {
    this.curve.inert = on;
  }

  /** @param {FunctionReply} reply */
  #take(reply) {
    this.reply = reply;
    // A function is not replaced while it is edited; the reply to its last state follows.
    if (this.editor.dragging) return;
    const own = this.page.history.state["transfer-function"];
    this.editor.edited = functions.edited_function(reply, own, Number(this.page.option("opacity") ?? 1));
    if (typeof own !== "object") this.editor.edited.name = preset_of(own ?? reply.name) ?? this.editor.edited.name;
    this.#show();
  }

  #show() {
    const { reply, editor } = this;
    if (!reply || !editor.edited) return;
    editor.show(editor.edited, this.histogram);
    show_value(this.low, short_number(editor.edited.range[0], 5));
    show_value(this.high, short_number(editor.edited.range[1], 5));
    show_value(this.distance, short_number(reply.unit_distance, 5));
    const [name, shape] = this.#words();
    for (const swatch of this.swatches.children) {
      const chosen = swatch.getAttribute("data-preset") === name;
      swatch.setAttribute("aria-pressed", String(chosen));
    }
    this.shape.value = shape ?? "";
    this.few.hidden = editor.edited.colors.length <= functions.most_handles;
    const warnings = reply.warnings ?? [];
    this.warning.hidden = warnings.length === 0;
    this.warning.textContent = warnings.map((line) => sentence_of(in_page_words(line))).join(" ");
    this.#show_selection();
    this.page.function_shown();
  }

  /** The function option of the state, or that with which the server was started; undefined: the server chooses. @returns {any} */
  get #word() {
    const { history, started } = this.page;
    return history.state["transfer-function"] ?? started["transfer-function"];
  }

  /** Names of the preset's colours and opacities, if any. @returns {[string | undefined, string | undefined]} */
  #words() {
    const word = this.#word;
    if (typeof word === "string") {
      const [name, shape] = word.split(":");
      const has_points = this.page.option("opacity-points");
      return [name, has_points ? undefined : (shape ?? this.page.data.opacities[0])];
    }
    const { edited } = this.editor, shape = this.chosen_shape;
    const has_shape = edited && shape && same(edited.opacities.map(rounded), shape.opacities.map(rounded));
    return [this.page.data.presets.some((preset) => preset.name === edited?.name) ? edited?.name : undefined, has_shape ? shape.name : undefined];
  }

  /**
   * Sets the colours or the opacities to a preset's; the other stays. The option is a name if both are presets,
   * otherwise points.
   * @param {string | undefined} colors @param {string | undefined} shape
   */
  async #choose(colors, shape) {
    const [name, old_shape] = this.#words();
    const word = this.#word;
    // A name is set unless the server's default function is edited: a name would not keep the range of that function, so its points are set below.
    if (typeof word === "string" || (word !== undefined && colors === undefined && name !== undefined) || this.editor.edited === undefined) {
      const both = `${colors ?? name ?? "cool-warm"}:${shape ?? old_shape ?? "ramp"}`;
      if (both !== word) this.#hold(true); // the previous function is drawn until the server answers
      this.page.history.change({ "transfer-function": both, ...(shape ? { "opacity-points": this.page.unset("opacity-points") } : {}) });
      return;
    }
    const state = { ...this.page.full_state(), opacity: null, "transfer-function": `${colors ?? "gray"}:${shape ?? "ramp"}`, range: this.editor.edited.range.join(",") };
    this.#hold(true);
    const reply = await this.page.messages.of(ask_about("api/function", { state }), "function");
    this.#hold(false);
    if (!reply) return;
    const preset = functions.edited_function(reply);
    const { edited } = this.editor;
    if (shape) this.chosen_shape = { name: shape, opacities: preset.opacities };
    this.#edit(shape ? { ...edited, opacities: preset.opacities }
      : { ...edited, colors: preset.colors, color_space: preset.color_space, hsv_wrap: preset.hsv_wrap, name: colors ?? edited.name }, false);
  }

  /** @param {EditedFunction} edited @param {boolean} moving */
  #edit(edited, moving) {
    this.editor.edited = edited;
    this.page.history.change(functions.state_of(edited), { moving, name: "function" });
    this.#show();
  }

  /** Reverts a cancelled drag. */
  #cancel() {
    this.page.history.cancel();
    this.#show();
  }

  /** @param {[number, number]} range @param {boolean} [moving] */
  #set_range(range, moving = false) {
    const keys = typeof this.page.history.state["transfer-function"] === "object" && this.editor.edited
      ? functions.state_of({ ...this.editor.edited, range }) : { range: range.join(",") };
    this.page.history.change(keys, { moving, name: "range" });
    show_value(this.low, short_number(range[0], 5));
    show_value(this.high, short_number(range[1], 5));
  }

  /** @param {string | undefined} low @param {string | undefined} high */
  #type_range(low, high) {
    const { edited } = this.editor;
    if (!edited) return false;
    const range = /** @type {[number, number]} */ ([low === undefined ? edited.range[0] : parsed_number(low), high === undefined ? edited.range[1] : parsed_number(high)]);
    if (!(range[0] < range[1]) || (edited.log && !(range[0] > 0))) return false;
    if (!same(range, edited.range)) this.#set_range(range);
    return true;
  }

  /** @param {"whole"|"most"|"visible"} kind */
  async #range_of(kind) {
    const question = { state: this.page.full_state(), bins: 256, visible: kind === "visible" };
    const reply = await this.page.messages.of(ask_about("api/histogram", question), "range");
    if (!reply) return;
    const ends = kind === "whole" ? reply.range : [reply.quantiles["0.005"] ?? reply.range[0], reply.quantiles["0.995"] ?? reply.range[1]];
    if (ends[0] < ends[1]) this.#set_range(ends);
    else this.page.messages.complain("All of these values are the same, so they are not a range.", { about: "range" });
  }

  /** The colour bar's scale option, which is refused without a bar. @param {boolean} on @param {boolean} log */
  #bar_scale(on, log) {
    return { "color-bar-scale": on && log ? "log" : this.page.unset("color-bar-scale") };
  }

  /** @param {boolean} on */
  #set_bar(on) {
    const { page } = this;
    page.history.change({ "color-bar": on ? page.switched_on("color-bar") : page.unset("color-bar"), ...this.#bar_scale(on, page.option("log") === true) });
  }

  /** @param {boolean} on */
  #set_log(on) {
    const { edited } = this.editor;
    const log = on ? true : this.page.unset("log");
    if (!edited) return;
    // A range that begins at or below zero has no logarithm: the server then starts at the smallest positive value.
    const range = on && !(edited.range[0] > 0) ? this.page.unset("range") : edited.range.join(",");
    const own = typeof this.page.history.state["transfer-function"] === "object";
    const points = own ? { "transfer-function": functions.state_of({ ...edited, log: on })["transfer-function"] } : {};
    this.page.history.change({ log, ...this.#bar_scale(Boolean(this.page.option("color-bar")), on), ...points, ...(own || this.page.history.state.range || this.page.started.range ? { range } : {}) });
  }

  /** @param {boolean} moving */
  #set_strength(moving) {
    const factor = Number((10 ** Number(this.strength.value)).toPrecision(3));
    this.page.history.change({ opacity: factor === 1 ? this.page.unset("opacity") : String(factor) }, { moving, name: "opacity" });
    show_value(this.strength_text, short_number(factor, 3));
  }

  /** @param {string} text */
  #type_strength(text) {
    const factor = parsed_number(text);
    if (!(factor > 0)) return false;
    this.page.history.change({ opacity: factor === 1 ? this.page.unset("opacity") : String(factor) });
    return true;
  }

  /** @param {string} text */
  #type_distance(text) {
    const distance = parsed_number(text);
    if (!(distance > 0) && text.trim() !== "") return false;
    const own = this.page.history.state["transfer-function"];
    const points = typeof own === "object" && distance > 0 ? { "transfer-function": { ...own, ScalarOpacityUnitDistance: distance }, "unit-distance": this.page.unset("unit-distance") }
      : { "unit-distance": distance > 0 ? String(distance) : undefined };
    this.page.history.change(points);
    return true;
  }

  #add_in_gap() {
    const { edited } = this.editor;
    if (!edited) return;
    let widest = 1;
    edited.opacities.forEach((p, i) => {
      if (i > 0 && p[0] - edited.opacities[i - 1][0] > edited.opacities[widest][0] - edited.opacities[widest - 1][0]) widest = i;
    });
    this.editor.add_point((edited.opacities[widest][0] + edited.opacities[widest - 1][0]) / 2);
  }

  #show_selection() {
    const { edited, selection } = this.editor ?? {};
    const list = edited && selection && (selection.kind === "opacity" ? edited.opacities : edited.colors);
    const point = list?.[selection?.index ?? -1];
    for (const input of [this.point_value, this.point_opacity, this.point_color]) input.disabled = !point;
    this.point_opacity.disabled ||= selection?.kind !== "opacity";
    this.remove.disabled = !point || !list || selection?.index === 0 || selection?.index === list.length - 1;
    this.point_value.placeholder = "value";
    this.point_opacity.placeholder = "opacity";
    if (!edited || !point) {
      for (const input of [this.point_value, this.point_opacity]) show_value(input, "");
      return;
    }
    this.point_value.disabled = selection?.index === 0 || selection?.index === (list?.length ?? 0) - 1;
    show_value(this.point_value, short_number(functions.value_at(edited, point[0]), 6));
    show_value(this.point_opacity, selection?.kind === "opacity" ? short_number(point[1], 4) : "");
    show_value(this.point_color, functions.hex_color(functions.color_at(edited, point[0])));
  }

  /** @param {string | undefined} value @param {string | undefined} opacity */
  #type_point(value, opacity) {
    const { edited, selection } = this.editor;
    if (!edited || !selection) return false;
    const list = selection.kind === "opacity" ? edited.opacities : edited.colors;
    const point = list[selection.index];
    const t = value === undefined ? point[0] : fraction_of(parsed_number(value), edited.range, edited.log);
    if (!(t >= 0 && t <= 1)) return false;
    if (selection.kind === "color") this.#edit(functions.with_color(edited, selection.index, t, point.slice(1)), false);
    else {
      const wanted = opacity === undefined ? point[1] : parsed_number(opacity);
      if (!(wanted >= 0 && wanted <= 1)) return false;
      this.#edit(functions.with_opacity(edited, selection.index, t, wanted), false);
    }
    return true;
  }

  /** @param {boolean} moving */
  #color_point(moving) {
    const { edited, selection } = this.editor;
    if (!edited || !selection) return;
    const rgb = functions.color_of_hex(this.point_color.value);
    const list = selection.kind === "opacity" ? edited.opacities : edited.colors;
    const t = list[selection.index][0];
    this.#edit(selection.kind === "color" ? functions.with_color(edited, selection.index, t, rgb) : functions.with_color_point(edited, t, rgb).edited, moving);
  }

  #reverse() {
    if (this.editor.edited) this.#edit(functions.with_colors_reversed(this.editor.edited), false);
  }

  async #import() {
    const [chosen] = this.file.files ?? [];
    if (!chosen) return;
    const text = await chosen.text();
    this.file.value = "";
    const taken = await this.page.messages.of(Promise.resolve().then(() => functions.imported_function(text)), "import");
    const { page } = this;
    if (taken) page.history.change({ "transfer-function": taken, range: page.unset("range"), log: page.unset("log") });
  }

  #export() {
    if (!this.reply) return;
    this.page.save(new Blob([JSON.stringify(this.reply.paraview, null, 1)], { type: "application/json" }), "transfer-function.json");
  }
}

