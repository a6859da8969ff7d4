// SPDX-License-Identifier: BSD-3-Clause
/** Messages for the user: read aloud by screen readers; they disappear by themselves unless they are errors. */
import { button, by_id, element, icon_button } from "./dom.js";

/** Milliseconds. */
const shown_for = 6000;

export class Messages {
  constructor() {
    this.list = by_id("messages");
    this.spoken = by_id("spoken");
    /** @type {Map<string, HTMLElement>} */
    this.shown = new Map();
  }

  /** Reports an event. @param {string} sentence */
  tell(sentence) {
    this.#show("note", `note:${sentence}`, sentence);
    this.spoken.textContent = sentence;
  }

  /**
   * Reports an error. `about`: key by which a later call replaces it and clear() removes it.
   * @param {string} sentence @param {{about?: string, action?: {text: string, act: () => void}}} [how]
   */
  complain(sentence, { about = sentence, action } = {}) {
    this.#show("error", about, sentence, action);
  }

  /** @param {string} about */
  clear(about) {
    this.shown.get(about)?.remove();
    this.shown.delete(about);
  }

  clear_errors() {
    for (const [about, line] of [...this.shown]) if (line.classList.contains("error")) this.clear(about);
  }

  /** Reports the error of a promise. @template T @param {Promise<T>} work @param {string} [about] @returns {Promise<T | undefined>} */
  async of(work, about) {
    try {
      const result = await work;
      if (about) this.clear(about);
      return result;
    } catch (error) {
      this.complain(error instanceof Error ? error.message : String(error), { about });
      return undefined;
    }
  }

  /** @param {"note"|"error"} kind @param {string} about @param {string} sentence @param {{text: string, act: () => void}} [action] */
  #show(kind, about, sentence, action) {
    const before = this.shown.get(about);
    // Several requests often fail for the same reason, which is reported only once.
    if (!before && [...this.shown.values()].some((line) => line.firstChild?.textContent === sentence)) return;
    const line = element("div", { class: `message ${kind}`, role: kind === "error" ? "alert" : undefined },
      element("span", {}, sentence),
      action && button(action.text, action.act),
      icon_button("close", "Dismiss", () => this.clear(about)));
    if (before) before.replaceWith(line);
    else this.list.append(line);
    this.shown.set(about, line);
    if (kind === "note") setTimeout(() => this.shown.get(about) === line && this.clear(about), shown_for);
  }
}
