// SPDX-License-Identifier: BSD-3-Clause
/**
 * The world's axes in the page's corner; they turn with the view immediately. Each end is a button for the view from
 * there.
 *
 * @typedef {import("./types.js").Camera} Camera
 * @typedef {import("./types.js").Vector} Vector
 */
import { basis_of } from "./camera.js";
import { svg } from "./dom.js";
import { dot } from "./vector.js";

/** Name and direction of an end, and the name of the view from there. @type {[string, Vector, string][]} */
const ends = [["x", [1, 0, 0], "right"], ["y", [0, 1, 0], "back"], ["z", [0, 0, 1], "top"], ["-x", [-1, 0, 0], "left"], ["-y", [0, -1, 0], "front"], ["-z", [0, 0, -1], "bottom"]];

export class AxesWidget {
  /** @param {SVGElement} element @param {(view: string) => void} look */
  constructor(element, look) {
    this.element = element;
    this.parts = ends.map(([name, direction, view]) => {
      const positive = !name.startsWith("-");
      const line = svg("line", { class: `axis ${name.slice(-1)}`, x1: 0, y1: 0 });
      const act = () => look(view);
      const end = svg("g", {
        class: `axis-end ${name.slice(-1)}${positive ? "" : " negative"}`, role: "button", tabindex: 0, "aria-label": `Look from ${positive ? "+" : ""}${name}`,
        on_click: act, on_keydown: (/** @type {KeyboardEvent} */ e) => {
          if (e.key !== "Enter" && e.key !== " ") return;
          e.preventDefault();
          e.stopPropagation();
          act();
        },
      }, svg("circle", { r: 8 }), positive && svg("text", { "text-anchor": "middle", y: 4 }, name), svg("title", {}, `Look from ${positive ? "+" : ""}${name}`));
      return { direction, positive, line, end };
    });
    element.append(...this.parts.filter((p) => p.positive).map((p) => p.line), ...this.parts.map((p) => p.end));
  }

  /** @param {Camera} camera */
  show(camera) {
    const { right, up, forward } = basis_of(camera);
    for (const part of this.parts) {
      const x = 30 * dot(part.direction, right), y = -30 * dot(part.direction, up);
      const depth = dot(part.direction, forward);
      part.end.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
      part.line.setAttribute("x2", x.toFixed(2));
      part.line.setAttribute("y2", y.toFixed(2));
      part.end.classList.toggle("behind", depth > 0.05);
      part.line.classList.toggle("behind", depth > 0.05);
    }
    // The nearer end is drawn, and reacts, in front of the farther one. Not while one has the focus, which moving would remove.
    if (this.element.contains(document.activeElement)) return;
    const sorted = [...this.parts].sort((a, b) => dot(b.direction, forward) - dot(a.direction, forward));
    for (const part of sorted) this.element.append(part.end);
  }
}
