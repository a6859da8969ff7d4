/**
 * What the file holds, what of it is drawn, and whether the mesh is sound.
 *
 * @typedef {import("./page.js").Page} Page
 */
import { button, element } from "./dom.js";
import { counted, short_number } from "./numbers.js";
import { ask_about } from "./requests.js";
import { in_page_words } from "./wording.js";

export class InformationPanel {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.facts = element("dl", { class: "facts" });
    this.notes = element("ul", { class: "notes" });
    this.check_button = button("Check the mesh", () => void this.#check(), { title: "As tessera info --check" });
    this.result = element("dl", { class: "facts", "aria-live": "polite" });
    this.element = element("div", { class: "panel-body" }, this.facts, this.notes, element("div", { class: "buttons" }, this.check_button), this.result);
  }

  begin() {
    const { data } = this.page;
    const vector = (/** @type {number[]} */ v) => v.map((n) => short_number(n, 4)).join(", ");
    const left_out = Object.entries(data.counts ?? {}).filter(([name, count]) => name !== "read" && count > 0);
    const lines = [
      ["File", data.file], ["Format", data.format], [data.kind === "mesh" ? "Cells" : "Samples", counted(data.cells ?? 0)],
      data.tets && data.tets !== data.cells ? ["Tetrahedra", counted(data.tets)] : null,
      ...left_out.map(([name, count]) => [data.kind === "mesh" ? (name === "cut" ? "Cut by a clip" : `Left out, ${name.replaceAll("_", " ")}`) : "Blank samples", counted(count)]),
      ["Low corner", vector(data.bounds[0])], ["High corner", vector(data.bounds[1])],
      ["Processes", `${data.ranks ?? 1}, threads ${data.threads ?? "all"}`], ["Tessera", data.tessera ?? ""],
    ];
    this.facts.replaceChildren(...lines.filter((line) => line !== null).flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
    this.check_button.hidden = data.kind !== "mesh";
    this.tell_notes([]);
  }

  /** @param {string[]} warnings of the frame that is shown */
  tell_notes(warnings) {
    const { data } = this.page;
    const lines = [...new Set([...(data.warnings ?? []), ...warnings, ...(data.notes ?? [])])];
    this.notes.replaceChildren(...lines.map((line) => element("li", {}, in_page_words(line))));
  }

  async #check() {
    this.check_button.disabled = true;
    this.result.replaceChildren(element("dt", {}, "…"), element("dd", {}, "checking"));
    const reply = await this.page.messages.of(ask_about("api/check", { state: this.page.full_state() }), "check");
    this.check_button.disabled = false;
    this.result.replaceChildren(...flattened(reply ?? {}).flatMap(([name, value]) => [element("dt", {}, name.replaceAll("_", " ")), element("dd", {}, value)]));
  }
}

/** Names and values of what a reply holds, lists shortened. @param {any} value @param {string} [name] @returns {[string, string][]} */
export function flattened(value, name = "") {
  if (Array.isArray(value)) {
    const simple = value.every((v) => typeof v !== "object" || v === null);
    if (simple) return [[name, value.length > 0 ? value.slice(0, 8).map(text_of).join(", ") + (value.length > 8 ? ", …" : "") : "none"]];
    return value.slice(0, 8).flatMap((v, i) => flattened(v, `${name} ${i + 1}`));
  }
  if (typeof value === "object" && value !== null) return Object.entries(value).flatMap(([word, v]) => flattened(v, name ? `${name}, ${word}` : word));
  return [[name, text_of(value)]];
}

/** @param {any} value */
const text_of = (value) => (typeof value === "number" ? (Number.isInteger(value) ? counted(value) : short_number(value, 5)) : value === true ? "yes" : value === false ? "no" : value === null ? "–" : String(value));
