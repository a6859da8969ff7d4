// SPDX-License-Identifier: BSD-3-Clause
/**
 * Saving of pictures and films, links and commands that reproduce them.
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./types.js").Camera} Camera
 */
import { link_of } from "./address.js";
import { button, checkbox, choice, element, fill_choice, icon_button, row, show_value, typed } from "./dom.js";
import { counted, parsed_number, short_number } from "./numbers.js";
import { command_of } from "./page.js";
import { ask, post } from "./requests.js";

/** @type {Record<string, string>} */
const film_names = { mp4: "MP4", webm: "WebM", gif: "GIF" };

export class PicturePanel {
  /** @param {Page} page @param {() => void} size_changed */
  constructor(page, size_changed) {
    this.page = page;
    this.size_changed = size_changed;
    /** Key views of a film. @type {Camera[]} */
    this.views = [];
    /** @type {AbortController | undefined} */
    this.filming = undefined;
    this.width = typed("Width, pixels", () => this.#sides() !== undefined, { class: "short", inputmode: "numeric" });
    this.height = typed("Height, pixels", () => this.#sides() !== undefined, { class: "short", inputmode: "numeric" });
    this.format = choice("", () => {}, [["png", "PNG"], ["exr", "OpenEXR, linear"], ["jpg", "JPEG"]]);
    this.clear = checkbox("Without background", () => {}, "With alpha, PNG and OpenEXR");
    this.save_button = button("Save", () => void this.save(), { class: "primary" });
    this.fixed = checkbox("Show at this size", (on) => this.#fix(on), "Otherwise the image fills the window");
    this.accuracy = typed("", (text) => {
      const bound = parsed_number(text);
      if (!(bound > 0) && text.trim() !== "") return false;
      page.history.change({ accuracy: bound > 0 ? String(bound) : page.unset("accuracy") });
      return true;
    }, { placeholder: "1e-4", title: "Largest error of the linear RGBA of a pixel" });
    this.kind = choice("", () => this.#show_film(), [["orbit", "full orbit"], ["views", "along key views"]]);
    this.frames = typed("", (text) => parsed_number(text) >= 2, { value: "120", class: "short", inputmode: "numeric" });
    this.rate = typed("Frames a second", (text) => parsed_number(text) > 0, { value: "25", class: "short" });
    this.film_format = choice("Video encoding", () => {});
    this.view_list = element("ol", { class: "key-views" });
    this.view_part = element("div", { class: "group", hidden: true }, this.view_list, element("div", { class: "buttons" }, button("Add this view", () => this.#add_view())));
    this.film_button = button("Make film", () => void this.#film(), { class: "primary" });
    this.film_progress = element("progress", { max: 1, hidden: true, "aria-label": "Progress of the film" });
    this.film_stop = button("Stop", () => this.filming?.abort(), { hidden: true });
    this.film_part = element("div", { class: "group" },
      row("Path", this.kind), this.view_part, row("Frames", this.frames, element("span", { class: "times" }, "at"), this.rate, element("span", { class: "times", title: "frames a second" }, "per s")),
      element("div", { class: "row" }, this.film_format, this.film_button, this.film_stop), this.film_progress);
    this.no_film = element("p", { class: "hint" });
    this.element = element("div", { class: "panel-body" },
      element("div", { class: "row" }, element("span", { class: "label" }, "Size"), this.width, element("span", { class: "times" }, "×"), this.height, icon_button("fit", "The window's size", () => this.#take_window())),
      element("div", { class: "checks" }, this.fixed.label),
      row("Accuracy", this.accuracy),
      row("Format", this.format, this.save_button), element("div", { class: "checks" }, this.clear.label),
      element("div", { class: "buttons" }, button("Copy link", () => void this.copy_link()), button("Copy command", () => void this.copy_command(), { title: "The tessera render command of this image" })),
      element("div", { class: "heading" }, "Film"), this.no_film, this.film_part);
  }

  begin() {
    const { formats, problem } = this.page.data.films;
    fill_choice(this.film_format, formats.map((format) => /** @type {[string, string]} */ ([format, film_names[format] ?? format])));
    this.film_part.hidden = formats.length === 0;
    this.no_film.hidden = problem === null;
    this.no_film.textContent = `${formats.length === 0 ? "No films" : "Not all forms of films"} are offered: ${problem}; install ffmpeg on the server (Debian: apt install ffmpeg), and reload this page.`;
    this.update();
  }

  update() {
    const size = this.page.view.size();
    show_value(this.accuracy, String(this.page.option("accuracy") ?? ""));
    if (this.fixed.input.checked !== (this.page.view.fixed !== undefined)) this.fixed.input.checked = this.page.view.fixed !== undefined;
    if (!this.typed_size || this.page.view.fixed) {
      show_value(this.width, String(size.width));
      show_value(this.height, String(size.height));
    }
  }

  /** Returns the typed size, if it is valid. */
  #sides() {
    const width = parsed_number(this.width.value), height = parsed_number(this.height.value);
    const good = (/** @type {number} */ side) => Number.isInteger(side) && side >= 1 && side <= 16384;
    this.typed_size = true;
    if (!good(width) || !good(height)) return undefined;
    if (this.page.view.fixed) this.page.history.change({ size: `${width}x${height}` });
    return { width, height };
  }

  #take_window() {
    this.typed_size = false;
    this.page.history.change({ size: undefined });
    this.size_changed();
    this.update();
  }

  /** @param {boolean} on */
  #fix(on) {
    const sides = this.#sides();
    this.page.history.change({ size: on && sides ? `${sides.width}x${sides.height}` : undefined });
    if (!on) this.typed_size = false;
  }

  async save() {
    const size = this.#sides();
    if (!size) {
      this.page.messages.complain("Width and height are whole numbers of pixels, from 1 to 16384.", { about: "save" });
      return;
    }
    const format = this.format.value;
    /** @type {Record<string, any>} */
    const state = { ...this.page.full_state(), size: `${size.width}x${size.height}` };
    if (this.clear.input.checked && format !== "jpg") {
      state.background = null;
    }
    await this.#busy(this.save_button, async () => {
      const response = await post("picture", { state, format });
      this.page.save(await response.blob(), name_of(response) ?? `${this.#stem()}.${format}`, `${size.width} × ${size.height} pixels`);
    }, "save");
  }

  #stem() {
    return this.page.data.file.replace(/^.*[\\/]/, "").replace(/\.[^.]*$/, "") || "picture";
  }

  /** @param {HTMLButtonElement} control @param {() => Promise<void>} work @param {string} about */
  async #busy(control, work, about) {
    control.disabled = true;
    control.setAttribute("aria-busy", "true");
    try {
      await this.page.messages.of(work(), about);
    } finally {
      control.disabled = false;
      control.removeAttribute("aria-busy");
    }
  }

  /** The address of exactly this picture. */
  link() {
    return link_of(location.href, this.page.full_state());
  }

  async copy_link() {
    await this.#copy(this.link(), "Link copied, without the token: another tab or browser is asked for the address that tessera serve printed.");
  }

  async copy_command() {
    const command = await this.page.messages.of(command_of(this.page.full_state()), "command");
    if (command) await this.#copy(command, "Command copied; it makes exactly this image.");
  }

  /** @param {string} text @param {string} sentence */
  async #copy(text, sentence) {
    this.copied = text;
    try {
      await navigator.clipboard.writeText(text);
      this.page.messages.tell(sentence);
    } catch {
      // A page loaded over plain HTTP from another machine may not use the clipboard.
      this.page.messages.complain(`The browser does not let the page copy; here is the text: ${text}`, { about: "copy" });
    }
  }

  #add_view() {
    this.views.push(this.page.camera);
    this.#show_film();
  }

  #show_film() {
    this.view_part.hidden = this.kind.value !== "views";
    this.view_list.replaceChildren(...this.views.map((camera, i) => element("li", {},
      button(`View ${i + 1}`, () => this.page.history.change({ camera }), { title: "Look from there" }),
      icon_button("up", `Move view ${i + 1} up`, () => this.#move_view(i), { disabled: i === 0 }),
      icon_button("trash", `Remove view ${i + 1}`, () => {
        this.views.splice(i, 1);
        this.#show_film();
      }))));
  }

  /** @param {number} index */
  #move_view(index) {
    this.views.splice(index - 1, 0, ...this.views.splice(index, 1));
    this.#show_film();
  }

  async #film() {
    const frames = parsed_number(this.frames.value), rate = parsed_number(this.rate.value), size = this.#sides();
    const views = this.kind.value === "views";
    if (!Number.isInteger(frames) || frames < 2 || !(rate > 0) || !size) return this.page.messages.complain("A film has two frames or more, a rate above 0 and a size in pixels.", { about: "film" });
    if (views && this.views.length < 2) return this.page.messages.complain("A film along key views needs two of them; turn the view and press Add this view.", { about: "film" });
    const format = this.film_format.value;
    const state = { ...this.page.full_state(), size: `${size.width}x${size.height}` };
    this.filming = new AbortController();
    const timer = setInterval(() => void this.#show_progress(), 700);
    this.film_progress.hidden = this.film_stop.hidden = false;
    this.film_progress.removeAttribute("value");
    const { signal } = this.filming;
    await this.#busy(this.film_button, async () => {
      try {
        const response = await post("film", { state, ...(views ? { views: this.views, frames } : { orbit: frames }), format, rate }, signal);
        this.page.save(await response.blob(), name_of(response) ?? `${this.#stem()}.${format}`, `${counted(frames)} frames`);
      } catch (error) {
        if (!signal.aborted) throw error;
        this.page.messages.tell("The film was stopped.");
      }
    }, "film");
    clearInterval(timer);
    this.filming = undefined;
    this.film_progress.hidden = this.film_stop.hidden = true;
  }

  async #show_progress() {
    const progress = await ask("api/progress").catch(() => undefined);
    const fraction = progress?.film;
    if (typeof fraction === "number" && this.filming) {
      this.film_progress.value = fraction;
      this.film_progress.title = `${short_number(fraction * 100, 3)} %`;
    }
  }
}

/** The name that the server gives a file. @param {Response} response */
const name_of = (response) => /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition") ?? "")?.[1];
