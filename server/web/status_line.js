// SPDX-License-Identifier: BSD-3-Clause
/**
 * The line below the picture: what is shown, how long its stages took, and its accuracy.
 *
 * @typedef {import("./types.js").FrameHeader} FrameHeader
 * @typedef {import("./page.js").Page} Page
 */
import { button, by_id, element } from "./dom.js";
import { median_and_95 } from "./frames.js";
import { short_number, short_time } from "./numbers.js";
import { ask_about } from "./requests.js";

/** Largest number of latencies that are kept. */
const most_latencies = 2000;

export class StatusLine {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.level = element("span", { class: "level" });
    this.size = element("span", { class: "wide" });
    this.time = element("button", { type: "button", class: "plain", "aria-expanded": "false", title: "Where the time went", on_click: () => this.#toggle_stages() });
    this.error = element("span");
    this.latency = element("span", { class: "wide", title: "From the event to the painted image" });
    this.verify = button("Verify", () => void this.#verify(), { class: "plain", title: "Check 1,000 pixels against the reference" });
    this.verdict = element("span", { class: "verdict", role: "status" });
    this.stages = by_id("stages");
    by_id("status").append(this.level, this.size, this.time, this.error, this.latency, this.verdict, this.verify);
    /** For each frame while moving: milliseconds from the event that caused its state to its painting. @type {{ latency: number, preview: boolean }[]} */
    this.moving_latencies = [];
    /** @type {FrameHeader | undefined} */
    this.header = undefined;
  }

  /** @param {FrameHeader} header @param {number | undefined} latency milliseconds */
  show(header, latency) {
    this.header = header;
    const full = this.page.view.size();
    const part = header.width < full.width ? ` 1/${short_number(full.width / header.width, 2)}` : "";
    this.level.textContent = header.level === "moving" ? `moving${part}` : header.level === "exact" ? "exact" : "refining";
    this.level.dataset.level = header.level;
    if (header.preview) this.level.textContent += ", preview";
    this.size.textContent = `${header.width} × ${header.height}`;
    this.time.textContent = short_time(header.milliseconds);
    this.error.textContent = header.promised_error ? `error ≤ ${short_number(header.promised_error, 2)}` : header.preview ? "no error promised" : "";
    if (header.level === "moving") {
      if (latency !== undefined) {
        this.moving_latencies.push({ latency, preview: header.preview === true });
        if (this.moving_latencies.length > most_latencies) this.moving_latencies.shift();
      }
    } else {
      this.#show_stages();
    }
    this.latency.textContent = latency === undefined ? "" : `event to image ${short_time(latency)}`;
    if (header.level === "moving") this.verdict.textContent = "";
  }

  /** Call when the state has changed: the text described the previous picture. `sentence`: the reason, if no new one follows. @param {string} [sentence] */
  outdated(sentence) {
    this.verdict.textContent = "";
    if (sentence) {
      this.busy(sentence);
      this.error.textContent = "";
    }
  }

  /** Latencies of frames while moving; optionally only those of previews, or only those of the data themselves. @param {boolean} [preview] */
  latencies(preview) {
    const meant = this.moving_latencies.filter((frame) => preview === undefined || frame.preview === preview);
    return median_and_95(meant.map((frame) => frame.latency));
  }

  /** @param {string} text */
  busy(text) {
    this.level.textContent = text;
    this.level.dataset.level = "busy";
  }

  #toggle_stages() {
    const open = this.stages.hidden;
    this.stages.hidden = !open;
    this.time.setAttribute("aria-expanded", String(open));
    this.#show_stages();
  }

  #show_stages() {
    if (this.stages.hidden || !this.header) return;
    const stages = Object.entries(this.header.stages ?? {}).filter(([, ms]) => ms > 0);
    const most = Math.max(1e-9, ...stages.map(([, ms]) => ms));
    const { count, median, p95 } = this.latencies();
    this.stages.replaceChildren(
      element("table", {}, element("caption", {}, `Where ${short_time(this.header.milliseconds)} went`), element("tbody", {}, ...stages.map(([name, ms]) => {
        const bar = element("span", { class: "bar" });
        bar.style.width = `${(ms / most) * 100}%`;
        return element("tr", {}, element("th", { scope: "row" }, name.replaceAll("_", " ")), element("td", {}, short_time(ms)), element("td", { class: "bars" }, bar));
      }), this.header.encode_ms !== undefined && element("tr", {}, element("th", { scope: "row" }, "encoding"), element("td", {}, short_time(this.header.encode_ms)), element("td")))),
      element("p", { class: "hint" }, count > 0 ? `Event to image over ${count} moving frames: median ${short_time(median)}, 95 % within ${short_time(p95)}.` : "Turn the view to measure the time from event to image."));
  }

  async #verify() {
    this.verify.disabled = true;
    this.verdict.textContent = "verifying…";
    const reply = await this.page.messages.of(ask_about("api/verify", { state: this.page.full_state(), pixels: 1000 }), "verify");
    this.verify.disabled = false;
    if (!reply) {
      this.verdict.textContent = "";
      return;
    }
    const good = reply.promised === null || reply.promised === undefined || reply.largest_error <= reply.promised;
    this.verdict.textContent = `${good ? "✓" : "✗"} largest error in ${reply.pixels} pixels: ${short_number(reply.largest_error, 2)}${reply.excused ? `, ${reply.excused} excused` : ""}`;
    this.verdict.dataset.good = String(good);
  }
}
