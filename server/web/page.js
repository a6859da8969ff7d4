// SPDX-License-Identifier: BSD-3-Clause
/**
 * Shared by the parts of the page: the data, the state with its history, and the state that is sent to the server.
 *
 * @typedef {import("./types.js").Camera} Camera
 * @typedef {import("./types.js").Data} Data
 * @typedef {import("./types.js").State} State
 * @typedef {import("./types.js").Vector} Vector
 */
import { save_file } from "./dom.js";
import { field_named } from "./fields.js";
import { short_bytes } from "./numbers.js";
import { sent_state } from "./options.js";
import { ask_about, LatestQuestion } from "./requests.js";
import { length, subtract } from "./vector.js";

export class Page {
  /**
   * @param {import("./state.js").StateHistory} history @param {import("./messages.js").Messages} messages
   * @param {import("./picture_view.js").PictureView} view
   */
  constructor(history, messages, view) {
    this.history = history;
    this.messages = messages;
    this.view = view;
    this.camera_question = new LatestQuestion();
    /** Whether `data` is available. */
    this.ready = false;
    this.data = /** @type {Data} */ (/** @type {unknown} */ (undefined));
    /** The options with which the server was started; null: the option is left out, because nothing can be shown with it. @type {State} */
    this.started = {};
    /** The options with which the server was started, including those left out. @type {State} */
    this.whole_start = {};
    /** Ranges of fields without threshold and cuts, by the options that determine the field. @type {Map<string, [number, number]>} */
    this.whole_ranges = new Map();
    /** The box of the whole data, without cuts. @type {[Vector, Vector]} */
    this.whole_bounds = [[0, 0, 0], [1, 1, 1]];
    /** Called when a function is shown, for parts that use its colours. */
    this.function_shown = () => {};
    /** The edited function, for parts that show one of its colours. @type {() => import("./transfer_function.js").EditedFunction | undefined} */
    this.edited_function = () => undefined;
  }

  /** The effective value of an option: the state's, otherwise the one with which the server was started, or its default. @param {string} word @returns {any} */
  option(word) {
    return [this.history.state, this.started, this.data?.defaults ?? {}].find((options) => options[word] !== undefined)?.[word];
  }

  /** The state's value for an option that is off: undefined, or null if the server was started with it. @param {string} word */
  unset(word) {
    return this.started[word] ? null : undefined;
  }

  /** The state's value for an option that is on: undefined if the server was started with it, which may include a place. @param {string} word */
  switched_on(word) {
    return this.started[word] ? undefined : true;
  }

  /** @param {string} word @param {any} value undefined: off */
  set_option(word, value) {
    this.history.change({ [word]: value === undefined ? this.unset(word) : value });
  }

  /** The start options left out, in the form in which states remove them. @returns {State} */
  get #left_out() {
    return Object.fromEntries(Object.entries(this.started).filter(([, value]) => value === null));
  }

  /** Whether the first picture is shaded without an option. */
  get #is_shaded_unasked() {
    return this.data?.defaults.shade === true && !this.started.shade;
  }

  get is_shaded() {
    const { state } = this.history;
    const unlit = state["no-shade"] !== undefined ? state["no-shade"] : this.started["no-shade"];
    return !unlit && this.option("shade") === true;
  }

  /** @param {boolean} on */
  shade(on) {
    this.history.change(on ? { shade: this.#is_shaded_unasked ? undefined : this.switched_on("shade"), "no-shade": this.unset("no-shade") }
      : { shade: this.unset("shade"), "no-shade": this.#is_shaded_unasked ? true : undefined });
  }

  /** @returns {Camera} */
  get camera() {
    return this.history.state.camera ?? this.data.defaults.camera;
  }

  /** The picture's background: the chosen one, or one that suits the page. @returns {string | null} */
  get background() {
    return this.option("background") ?? (this.history.state.background === null ? null : page_background());
  }

  /** The complete state of the picture. @returns {State} */
  full_state() {
    const state = { ...this.#left_out, ...this.history.state, background: this.background, camera: this.camera, size: size_word(this.view.size()) };
    return sent_state(state, this.started, { shaded: this.#is_shaded_unasked });
  }

  /** Length of the data's diagonal, world units. */
  get extent() {
    const [low, high] = this.whole_bounds;
    return length(subtract(high, low)) || 1;
  }

  get #field_key() {
    return JSON.stringify([this.option("field") ?? null, this.option("time-step") ?? null, this.option("smooth") ?? null]);
  }

  /** Stores the description of the data. Parts cut away by options still count for ranges and bounds once they have been seen. @param {Data} data */
  take_data(data) {
    const cut = ["threshold", "clip", "block"].some((word) => this.option(word)), is_first = !this.data;
    this.data = { ...data, defaults: this.data?.defaults ?? data.defaults };
    if (cut && !is_first) {
      const [low, high] = this.whole_bounds;
      const ends = (/** @type {Vector} */ own, /** @type {Vector} */ other, /** @type {(a: number, b: number) => number} */ end) => /** @type {Vector} */ (own.map((v, i) => end(v, other[i])));
      this.whole_bounds = [ends(low, data.bounds[0], Math.min), ends(high, data.bounds[1], Math.max)];
      return;
    }
    this.whole_bounds = data.bounds;
    if (!cut && data.range) this.whole_ranges.set(this.#field_key, data.range);
  }

  /** Offers bytes as a file, and reports it. @param {Blob} blob @param {string} name @param {string} [shape] of the picture */
  save(blob, name, shape) {
    save_file(blob, name);
    this.messages.tell(`Saved ${name}: ${shape ? `${shape}, ` : ""}${short_bytes(blob.size)}.`);
  }

  /** The field's range, or 0 to 1 if it is unknown. @returns {[number, number]} */
  get field_range() {
    const word = String(this.option("field") ?? this.data.field ?? "");
    const range = this.whole_ranges.get(this.#field_key) ?? field_named(word, this.data.fields)?.range ?? this.data.range;
    return range && range[0] < range[1] ? range : [0, 1];
  }

  /** The description of the data with the server's start options, with a view framed for this window. @returns {Promise<Data>} */
  ask_data() {
    return ask_about("api/data", { state: { ...this.#left_out, size: size_word(this.view.size()) } });
  }

  /** @param {State} options that the server was started with */
  take_start(options) {
    this.started = { ...options };
    this.whole_start = options;
  }

  /**
   * Leaves out start options that may not fit the file: first the field, then all options that select the data to draw.
   * @returns {boolean} whether there was such an option
   */
  leave_out_of_start() {
    const there = (/** @type {string} */ word) => this.started[word] !== undefined && this.started[word] !== null;
    const words = there("field") ? ["field"] : ["time-step", "block", "smooth", "threshold", "clip"].filter(there);
    for (const word of words) this.started[word] = null;
    return words.length > 0;
  }

  /** A named view, computed by the server; "default" is the one with which the server was started. @param {string} view */
  async look(view) {
    if (!this.ready) return;
    if (view === "default") {
      const data = await this.messages.of(this.ask_data(), "camera");
      if (data) this.history.change({ camera: data.defaults.camera });
      return;
    }
    const perspective = this.camera.parallel_scale === undefined;
    const question = { state: this.full_state(), view, projection: perspective ? "perspective" : "orthographic" };
    const camera = await this.messages.of(this.camera_question.ask("api/camera", question), "camera");
    if (camera) this.history.change({ camera: camera.camera ?? camera });
  }

  /** Selects a field, and removes options in the values of the previous one. @param {string | undefined} field undefined: the server's initial one */
  set_field(field) {
    const own = this.history.state["transfer-function"];
    const in_values = Object.fromEntries(["range", "threshold", "iso", "color-bar-range"].map((word) => [word, field === undefined ? undefined : this.unset(word)]));
    this.history.change({ field, ...in_values, "transfer-function": typeof own === "string" ? own : undefined });
  }
}

/** Whether the browser asks for dark pages. */
export const dark = window.matchMedia("(prefers-color-scheme: dark)");
// Updated by the event, as `matches` may change earlier: otherwise a state could differ from the one requested.
let is_dark = dark.matches;
dark.addEventListener("change", () => { is_dark = dark.matches; });
const page_background = () => (is_dark ? "#15171b" : "#ffffff");

/** In the form of the option. @param {import("./types.js").Size} size */
export const size_word = ({ width, height }) => `${width}x${height}`;

/** The command of a state. @param {State} state @returns {Promise<string>} */
export const command_of = async (state) => (await ask_about("api/command", { state })).command;
