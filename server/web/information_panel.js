// SPDX-License-Identifier: BSD-3-Clause
/**
 * Contents of the file, the part of them that is drawn, and the check of the mesh.
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./mesh_check.js").Place} Place
 */
import { centred } from "./camera.js";
import { button, element } from "./dom.js";
import { check_rows, check_sentence, place_name } from "./mesh_check.js";
import { counted, short_number, short_place } from "./numbers.js";
import { ask_about } from "./requests.js";
import { in_page_words } from "./wording.js";

export class InformationPanel {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.facts = element("dl", { class: "facts" });
    this.notes = element("ul", { class: "notes" });
    this.check_button = button("Check the mesh", () => void this.#check(), { title: "As tessera info --check" });
    this.result = element("div", { class: "group", "aria-live": "polite" });
    this.element = element("div", { class: "panel-body" }, this.facts, this.notes, element("div", { class: "buttons" }, this.check_button), this.result);
  }

  begin() {
    const { data } = this.page;
    const vector = (/** @type {number[]} */ v) => v.map((n) => short_place(n, this.page.extent)).join(", ");
    const left_out = Object.entries(data.counts ?? {}).filter(([name, count]) => name !== "read" && count > 0);
    const lines = [
      ["File", data.file], ["Format", data.format], [data.kind === "mesh" ? "Cells" : "Samples", counted(data.cells ?? 0)],
      data.tets && data.tets !== data.cells ? ["Tetrahedra", counted(data.tets)] : null,
      ...left_out.map(([name, count]) => [data.kind === "mesh" ? (name === "cut" ? "Cut by a clip" : `Left out, ${name.replaceAll("_", " ")}`) : "Blank samples", counted(count)]),
      ["Bounds from", vector(data.bounds[0])], ["Bounds to", vector(data.bounds[1])],
      ["Processes", `${data.ranks ?? 1}, threads ${data.threads ?? "all"}`], ["Tessera", data.tessera ?? ""],
    ];
    this.facts.replaceChildren(...lines.filter((line) => line !== null).flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
    this.check_button.hidden = data.kind !== "mesh";
    this.tell_notes([]);
  }

  /** @param {string[]} warnings of the displayed frame */
  tell_notes(warnings) {
    const { data } = this.page;
    const lines = [...new Set([...(data.warnings ?? []), ...warnings, ...(data.notes ?? [])])];
    this.notes.replaceChildren(...lines.map((line) => element("li", {}, in_page_words(line))));
  }

  async #check() {
    this.check_button.disabled = true;
    this.result.replaceChildren(element("p", { class: "hint" }, "Checking …"));
    const reply = await this.page.messages.of(ask_about("api/check", { state: this.page.full_state() }), "check");
    this.check_button.disabled = false;
    this.result.replaceChildren(...(reply ? [element("p", { class: "verdict", "data-clean": String(reply.clean) }, check_sentence(reply)), this.#table(reply)] : []));
  }

  /** The findings, one per row, each followed by its first places. @param {Record<string, any>} reply */
  #table(reply) {
    const { page } = this;
    const place = (/** @type {string} */ name, /** @type {Place} */ found) => element("tr", { class: "place" }, element("td", { colspan: 2 },
      button(place_name(name, found), () => page.history.change({ camera: centred(page.camera, found.at) }), { class: "plain", title: "Centre the view there" }),
      ` at ${found.at.map((v) => short_place(v, page.extent)).join(", ")}`, found.value !== undefined && `; ${short_number(found.value, 3)}:1`));
    return element("div", { class: "scrolled", tabindex: 0, role: "group", "aria-label": "What the check found" }, element("table", { class: "findings" }, element("tbody", {}, ...check_rows(reply).flatMap(({ name, title, text, places }) =>
      [element("tr", {}, element("th", { scope: "row" }, title), element("td", {}, text)), ...places.map((found) => place(name, found))]))));
  }
}
