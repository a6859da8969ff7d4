// SPDX-License-Identifier: BSD-3-Clause
/**
 * Probing under the cursor: the first visible point of a ray, and the field and the opacity along it.
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./types.js").Vector} Vector
 */
import { centred, project } from "./camera.js";
import { button, by_id, element, svg } from "./dom.js";
import { linear_ticks, short_number, short_place } from "./numbers.js";
import { LatestQuestion } from "./requests.js";

const plot = { width: 320, height: 150, left: 40, right: 30, top: 8, bottom: 24 };

/** @type {Record<string, string>} */
const meanings = { Value: "at the first visible point of the ray", "Value at half opacity": "where the ray's opacity is half of what it comes to" };

export class ProbePanel {
  /** @param {Page} page @param {(value: number) => void} add_surface */
  constructor(page, add_surface) {
    this.page = page;
    this.question = new LatestQuestion();
    this.on = false;
    this.marker = by_id("marker");
    /** @type {Vector | undefined} */
    this.point = undefined;
    this.facts = element("dl", { class: "facts", "aria-live": "polite" });
    this.plot = svg("svg", { class: "profile", viewBox: `0 0 ${plot.width} ${plot.height}`, role: "img", "aria-label": "Value and opacity along the ray" });
    this.hint = element("p", { class: "hint" }, "Press P or the crosshair, and click on the image; on a touch screen hold a finger on it. Without a mouse: the button below probes the image's middle.");
    this.actions = element("div", { class: "buttons", hidden: true },
      button("Centre the view here", () => this.point && page.history.change({ camera: centred(page.camera, this.point) })),
      button("Add an iso-surface at this value", () => this.value !== undefined && add_surface(this.value)));
    this.element = element("div", { class: "panel-body" }, this.hint, element("div", { class: "buttons" }, button("Probe the middle", () => void this.probe({ x: 0, y: 0 }))), this.facts, this.plot, this.actions);
    this.plot.setAttribute("hidden", "");
  }

  begin() {}

  /** Drops the result for the previous data and any pending answer. Must be called for other data. */
  forget() {
    this.question.drop();
    this.point = undefined;
    this.value = undefined;
    this.facts.replaceChildren();
    this.plot.setAttribute("hidden", "");
    this.actions.hidden = true;
    this.place_marker();
  }

  /** @param {{x: number, y: number}} place picture coordinates */
  async probe(place) {
    if (!this.page.ready) return;
    const pixel = this.page.view.pixel_of(place);
    const reply = await this.page.messages.of(this.question.ask("api/probe", { state: this.page.full_state(), ...pixel, samples: 256 }), "probe");
    if (reply) this.#show(reply, pixel);
  }

  /** The point that is visible at a place, if there is one. @param {{x: number, y: number}} place @returns {Promise<Vector | undefined>} */
  async point_at(place) {
    const reply = await this.page.messages.of(this.question.ask("api/probe", { state: this.page.full_state(), ...this.page.view.pixel_of(place), samples: 2 }), "probe");
    return reply?.hit ? (reply.half_point ?? reply.point) : undefined;
  }

  /** @param {any} reply @param {{x: number, y: number}} pixel */
  #show(reply, pixel) {
    this.point = reply.hit ? reply.point : undefined;
    this.value = reply.hit ? reply.value : undefined;
    const vector = (/** @type {Vector} */ v) => v.map((n) => short_place(n, this.page.extent)).join(", ");
    const lines = reply.hit
      ? [["Value", short_number(reply.value, 6)], ["Point", vector(reply.point)], ["Depth", short_number(reply.depth, 5)],
        reply.half_value !== undefined && reply.half_value !== null && ["Value at half opacity", short_number(reply.half_value, 6)],
        reply.rgba && ["Colour", reply.rgba.map((/** @type {number} */ v) => short_number(v, 3)).join(", ")]]
      : [["Nothing", "no visible point on this ray"]];
    this.facts.replaceChildren(element("dt", {}, "Pixel"), element("dd", {}, `${pixel.x}, ${pixel.y}`),
      ...lines.filter(Boolean).flatMap((line) => [element("dt", { title: meanings[line[0]] }, line[0]), element("dd", {}, line[1])]));
    this.actions.hidden = !reply.hit;
    this.marker.dataset.value = reply.hit ? short_number(reply.value, 6) : "";
    if (!reply.hit) this.page.messages.tell("There is no visible point on this ray.");
    this.element.scrollIntoView({ block: "nearest" });
    this.#draw(reply.profile, reply.hit ? reply.depth : undefined);
    this.place_marker();
  }

  /** @param {{distance: number[], value: (number|null)[], opacity: number[]} | undefined} profile @param {number | undefined} depth */
  #draw(profile, depth) {
    const values = (profile?.value ?? []).filter((v) => v !== null);
    this.plot.toggleAttribute("hidden", values.length < 2);
    if (!profile || values.length < 2) return;
    const { distance } = profile;
    const used = profile.value.map((v, i) => (v === null ? -1 : i)).filter((i) => i >= 0);
    const from = distance[used[0]], to = distance[used[used.length - 1]] || from + 1;
    let [low, high] = [Math.min(...values), Math.max(...values)];
    if (!(high > low)) [low, high] = [low - 0.5, high + 0.5];
    const x = (/** @type {number} */ d) => plot.left + ((d - from) / (to - from || 1)) * (plot.width - plot.left - plot.right);
    const foot = plot.height - plot.bottom;
    const y = (/** @type {number} */ part) => foot - part * (foot - plot.top);
    let line = "", area = "", drawn = false;
    profile.value.forEach((v, i) => {
      if (v === null) {
        drawn = false;
        return;
      }
      line += `${drawn ? "L" : "M"}${x(distance[i]).toFixed(1)} ${y((v - low) / (high - low)).toFixed(1)}`;
      drawn = true;
    });
    for (let i = used[0]; i <= used[used.length - 1]; ++i) area += `${area ? "L" : "M"}${x(distance[i]).toFixed(1)} ${y(profile.opacity[i]).toFixed(1)}`;
    const ticks = [
      ...linear_ticks(from, to, 6).map((d) => svg("text", { x: x(d), y: plot.height - 8, "text-anchor": "middle", class: "tick" }, short_number(d, 4))),
      ...linear_ticks(low, high, 5).map((v) => svg("text", { x: plot.left - 4, y: y((v - low) / (high - low)) + 4, "text-anchor": "end", class: "tick value" }, short_number(v, 3))),
      ...[0, 0.5, 1].map((a) => svg("text", { x: plot.width - plot.right + 4, y: y(a) + 4, class: "tick opacity" }, String(a))),
    ];
    this.plot.replaceChildren(
      svg("title", {}, "Along the ray: the field's value (line, left axis) and the accumulated opacity (area, right axis) over the distance from the eye"),
      svg("rect", { x: plot.left, y: plot.top, width: plot.width - plot.left - plot.right, height: foot - plot.top, class: "frame" }),
      svg("path", { class: "opacity", d: `${area}L${x(to).toFixed(1)} ${foot}L${x(from).toFixed(1)} ${foot}Z` }),
      svg("path", { class: "value", d: line }),
      ...(depth !== undefined && depth >= from && depth <= to ? [svg("line", { class: "depth", x1: x(depth), x2: x(depth), y1: plot.top, y2: foot })] : []), ...ticks);
  }

  /** Moves the marker to the point, which stays with the data while the view turns. */
  place_marker() {
    const seen = this.point && this.page.ready ? project(this.page.camera, this.point) : undefined;
    this.marker.hidden = !seen;
    if (!seen) return;
    const { left, top } = this.page.view.window_place(seen);
    this.marker.style.transform = `translate(${left}px, ${top}px)`;
  }
}
