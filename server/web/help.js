// SPDX-License-Identifier: BSD-3-Clause
/** Help for mouse, touch and keyboard. */
import { button, by_id, element } from "./dom.js";

/** @type {[string, [string, string][]][]} */
const topics = [
  ["Mouse", [["Drag", "turn; when flying, look around"], ["Right, middle or Shift + drag", "move"], ["Ctrl + drag", "roll"], ["Wheel", "zoom to the cursor; when flying, forward"], ["Double-click", "centre the point there"], ["Alt + click", "probe"]]],
  ["Touch", [["One finger", "turn"], ["Two fingers", "move, zoom, and with the trackball roll"], ["Hold", "probe"]]],
  ["Keys on the image", [["← → ↑ ↓", "turn; with Shift move"], ["+ −, Page Up, Page Down", "zoom"], ["[ ]", "roll"], ["W A S D Q E", "when flying: forward, left, back, right, down, up"]]],
  ["Keys anywhere", [["Ctrl Z, Ctrl Shift Z", "undo, redo"], ["F", "fit the data"], ["R", "the default view"], ["1 to 6, 7", "front, back, left, right, top, bottom, corner"], ["O", "orthographic or perspective"], ["T", "turntable, trackball, fly"], ["P", "probe with a click"], ["Space", "play the time steps"], [", .", "previous, next time step"], ["L", "copy the link"], ["C", "copy the command"], ["?", "this list"]]],
  ["Keys in the transfer function", [["Tab", "to the next point"], ["Arrows", "move it; with Shift finely"], ["Enter", "add a point after it"], ["Delete", "remove it"]]],
];

const dialog = () => /** @type {HTMLDialogElement} */ (by_id("help"));

export function show_help() {
  if (dialog().childElementCount === 0)
    // The button comes first: a dialog scrolls to the element with the focus.
    dialog().append(element("div", { class: "title" }, element("h2", { id: "help-title" }, "Mouse, fingers and keys"), button("Close", () => dialog().close(), { class: "primary", autofocus: true })),
      element("div", { class: "topics" }, ...topics.map(([title, lines]) => element("section", {}, element("h3", {}, title), element("dl", {}, ...lines.flatMap(([keys, text]) => [element("dt", {}, keys), element("dd", {}, text)]))))));
  dialog().showModal();
}
