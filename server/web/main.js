// SPDX-License-Identifier: BSD-3-Clause
/**
 * The page of `tessera serve`: creates its parts and connects them.
 *
 * @typedef {import("./types.js").FrameHeader} FrameHeader
 * @typedef {import("./gestures.js").Mode} Mode
 */
import { fragment_of, state_of_fragment } from "./address.js";
import { AxesWidget } from "./axes_widget.js";
import { basis_of, centred, is_perspective, with_projection } from "./camera.js";
import { Connection } from "./connection.js";
import { DataPanel } from "./data_panel.js";
import { being_typed, button, by_id, debounced, element, icon_button, preference, set_preference } from "./dom.js";
import { StateSender } from "./frames.js";
import { Framing } from "./framing.js";
import { FunctionPanel } from "./function_panel.js";
import { Gestures } from "./gestures.js";
import { show_help } from "./help.js";
import { InformationPanel } from "./information_panel.js";
import { Messages } from "./messages.js";
import { dark, Page } from "./page.js";
import { PicturePanel } from "./picture_panel.js";
import { PictureView } from "./picture_view.js";
import { ProbePanel } from "./probe_panel.js";
import { LatestQuestion, Refused, StillReading, Unfit } from "./requests.js";
import { same, StateHistory } from "./state.js";
import { StatusLine } from "./status_line.js";
import { find_token, set_token } from "./token.js";
import { ViewPanel } from "./view_panel.js";
import { sentence_of } from "./wording.js";

by_id("not-loaded").remove();
find_token();
const history = new StateHistory();
const messages = new Messages();
const view = new PictureView();
const page = new Page(history, messages, view);
const status = new StatusLine(page);

/** @type {Mode[]} */
const modes = ["turntable", "trackball", "fly"];
let mode = /** @type {Mode} */ (modes.find((word) => word === preference("mode", "turntable")) ?? "turntable");
if (mode === "fly") mode = "turntable";

/** @param {string} word */
function set_mode(word) {
  mode = /** @type {Mode} */ (word);
  set_preference("mode", mode);
  // Flying forward has no visible effect in an orthographic view.
  if (mode === "fly" && page.ready && !is_perspective(page.camera)) history.change({ camera: with_projection(page.camera, true) });
  for (const tool of mode_tools) tool.setAttribute("aria-pressed", String(tool.dataset.mode === mode));
  view_panel.update();
}

const functions = new FunctionPanel(page);
page.edited_function = () => functions.editor.edited;
const data_panel = new DataPanel(page);
page.function_shown = () => data_panel.surfaces.update();
const view_panel = new ViewPanel(page, { mode: () => mode, set_mode });
const picture_panel = new PicturePanel(page, () => offer(false));
const probe = new ProbePanel(page, (value) => data_panel.surfaces.add(value));
const information = new InformationPanel(page);
const panels = [functions, data_panel, view_panel, picture_panel, probe, information];

/** @param {string} title @param {HTMLElement} body @param {boolean} open */
function section(title, body, open) {
  const made = element("details", { class: "section" }, element("summary", {}, title), body);
  made.open = preference(`open.${title}`, open ? "yes" : "no") === "yes";
  made.addEventListener("toggle", () => set_preference(`open.${title}`, made.open ? "yes" : "no"));
  return made;
}
const probe_section = section("Probe", probe.element, false);
by_id("panel").append(
  data_panel.field_row, section("Colour and opacity", functions.element, true), section("Data", data_panel.element, true), section("View", view_panel.element, false),
  section("Image and film", picture_panel.element, false), probe_section, section("Information", information.element, false));

// Tools.

const undo = icon_button("undo", "Undo (Ctrl Z)", () => history.undo(), { disabled: true });
const redo = icon_button("redo", "Redo (Ctrl Shift Z)", () => history.redo(), { disabled: true });
const panel_toggle = icon_button("panel", "Settings", () => show_panel(document.body.classList.contains("panel-closed")), { id: "panel-toggle", "aria-controls": "panel" });
const picture_tools = [icon_button("link", "Copy link (L)", () => void picture_panel.copy_link()), icon_button("command", "Copy command (C)", () => void picture_panel.copy_command()),
  icon_button("save", "Save the image", () => void picture_panel.save())];
by_id("tools").append(undo, redo, ...picture_tools, icon_button("help", "Keyboard shortcuts (?)", show_help), panel_toggle);
for (const tool of picture_tools) tool.disabled = true;

/** Enables the controls when data are available. */
function wake_controls() {
  for (const id of ["panel", "view-tools", "status"]) by_id(id).inert = false;
  by_id("axes").removeAttribute("hidden");
  for (const tool of picture_tools) tool.disabled = false;
}

/** @param {boolean} open */
function show_panel(open) {
  document.body.classList.toggle("panel-closed", !open);
  panel_toggle.setAttribute("aria-expanded", String(open));
}
show_panel(!window.matchMedia("(max-width: 760px)").matches);

const mode_names = { turntable: "Turntable", trackball: "Trackball", fly: "Fly (W A S D Q E)" };
const mode_tools = modes.map((word) => icon_button(word, `${mode_names[word]} (T)`, () => set_mode(word), { "data-mode": word, "aria-pressed": String(word === mode) }));
const probe_tool = icon_button("probe", "Probe with a click (P)", () => set_probing(!probe.on), { "aria-pressed": "false" });
by_id("view-tools").append(
  element("div", { role: "group", "aria-label": "Rotation" }, ...mode_tools), icon_button("fit", "Fit the data (F)", () => void page.look("fit")),
  icon_button("home", "Default view (R)", () => void page.look("default")), icon_button("projection", "Orthographic or perspective (O)", toggle_projection), probe_tool);

function toggle_projection() {
  if (page.ready) history.change({ camera: with_projection(page.camera, !is_perspective(page.camera)) });
}

/** @param {boolean} on */
function set_probing(on) {
  probe.on = on;
  probe_tool.setAttribute("aria-pressed", String(on));
  view.frame.classList.toggle("probing", on);
  if (on) probe_section.open = true;
}

const axes = new AxesWidget(/** @type {SVGElement} */ (/** @type {unknown} */ (by_id("axes"))), (name) => void page.look(name));

/** @param {{x: number, y: number}} place */
async function centre(place) {
  const point = page.ready ? await probe.point_at(place) : undefined;
  if (point) history.change({ camera: centred(page.camera, point) });
}

new Gestures(view.frame, {
  camera: () => (page.ready ? page.camera : undefined),
  // The up direction of the default view is that of the turntable.
  pole: () => upright(),
  extent: () => page.extent,
  move: (camera) => history.change({ camera }, { moving: true }),
  rest: (name) => history.settle(name),
  mode: () => mode,
  place_of: (x, y) => view.place_of(x, y),
  pick: (place) => {
    probe_section.open = true;
    void probe.probe(place);
  },
  centre: (place) => void centre(place),
  probing: () => probe.on,
  hover: debounced((/** @type {{x: number, y: number}} */ place) => {
    if (probe.on && !history.moving && Math.abs(place.y) < 0.5) void probe.probe(place);
  }, 120),
});

/** The world axis nearest to the up direction of the default view. */
function upright() {
  const { up } = basis_of(page.data.defaults.camera);
  const axis = up.map(Math.abs).indexOf(Math.max(...up.map(Math.abs)));
  return /** @type {import("./types.js").Vector} */ ([0, 1, 2].map((i) => (i === axis ? Math.sign(up[i]) : 0)));
}

// Sends states to the server, which answers with frames.

const sender = new StateSender((message) => connection.send(message));

/** @param {boolean} moving */
function offer(moving) {
  if (page.ready && !document.hidden) sender.offer(page.full_state(), moving);
}

/** @param {FrameHeader} header @param {Uint8Array<ArrayBuffer>} image */
async function show_frame(header, image) {
  let painted = false;
  try {
    painted = await view.paint(header, image);
  } catch {
    messages.complain("The browser cannot show the image that the server sent; reload the page.", { about: "frame" });
  }
  connection.send({ type: "ack", frame: header.frame });
  sender.answered(header.number);
  if (!painted) return;
  const event_time = sender.event_times.get(header.number);
  if (header.level === "moving" || !first_of.has(header.number)) status.show(header, event_time === undefined ? undefined : performance.now() - event_time);
  else status.show(header, undefined);
  first_of.add(header.number);
  if (first_of.size > 200) first_of.delete([...first_of][0]);
  messages.clear("state");
  end_reading();
  by_id("frame-progress").hidden = true;
  if (header.level !== "moving") information.tell_notes(header.warnings ?? []);
  document.body.dataset.shown = `${header.number} ${header.level}${header.final ? " final" : ""}`;
  data_panel.painted();
}
/** States whose first frame has been painted. @type {Set<number>} */
const first_of = new Set();

/** @param {{number?: number, error: string}} message */
function show_error(message) {
  if (message.number !== undefined) sender.answered(message.number);
  data_panel.stop();
  end_reading();
  by_id("frame-progress").hidden = true;
  const action = history.can_undo ? { text: "Undo", act: () => history.undo() } : { text: "Default view", act: () => history.load({}) };
  messages.complain(message.error, { about: "state", action });
  status.outdated("an older image: see the message");
  document.body.dataset.shown = `${message.number ?? 0} error`;
}

const connection = new Connection({
  status: show_connection,
  frame: (header, image) => void show_frame(header, image),
  message: (message) => {
    if (message.type === "welcome" && !same(message.base, page.whole_start)) {
      page.take_start(message.base);
      update_soon();
    }
    if (message.type === "welcome" || message.type === "data") void load_data();
    else if (message.type === "reading") show_reading(message);
    else if (message.type === "progress") show_progress(message);
    else if (message.type === "error") show_error(/** @type {any} */ (message));
    else if (message.type === "ended") show_connection("ended", { sentence: message.error });
  },
});

/** @param {import("./connection.js").Status} state @param {{sentence?: string, retry_at?: number}} detail */
function show_connection(state, detail) {
  const banner = by_id("banner");
  document.body.dataset.connection = state;
  clearInterval(countdown);
  if (state === "open") {
    if (!banner.hidden && page.ready) {
      messages.clear_errors();
      messages.tell("The connection is back.");
    }
    banner.hidden = true;
    view.forget_numbers();
    if (page.ready) sender.opened();
  } else if (state !== "connecting") {
    sender.closed();
    end_reading();
    const again = element("span");
    const text = state === "refused" ? detail.sentence ?? "The server refuses this page."
      : state === "ended" ? `The server has ended. ${/^the server (was|has) ended/i.test(detail.sentence ?? "") ? "" : detail.sentence ?? ""}` : detail.sentence || "The connection to the server is lost; the image stays, and changes are shown once it is back.";
    banner.replaceChildren(element("span", {}, text), again, ...(state === "refused" ? refused_controls(text) : [button("Try now", () => connection.retry())]));
    banner.hidden = false;
    if (detail.retry_at !== undefined) {
      const tell = () => { again.textContent = `Next try in ${Math.max(0, Math.ceil((/** @type {number} */ (detail.retry_at) - performance.now()) / 1000))} s.`; };
      tell();
      countdown = window.setInterval(tell, 500);
    }
  }
}
let countdown = 0;

/** Controls for a page that the server refuses: a field for another token, if that is the reason. @param {string} reason */
function refused_controls(reason) {
  const try_again = () => {
    if (address && address.value.trim() !== "" && !set_token(address.value)) {
      messages.complain("This is neither an address with a token nor a token; copy the line that tessera serve printed.", { about: "token" });
      return;
    }
    messages.clear("token");
    if (connection.is_open) void load_data();
    else connection.retry();
  };
  const address = /token/.test(reason) && element("input", {
    type: "text", autocomplete: "off", spellcheck: "false", "aria-label": "Address that tessera serve printed", placeholder: "the address that tessera serve printed",
    on_keydown: (/** @type {KeyboardEvent} */ event) => event.key === "Enter" && try_again(),
  });
  return [address || "", button("Try again", try_again)];
}

let reading_delay = 0;

/** @param {{stage?: string, fraction?: number|null}} progress */
function show_reading({ stage, fraction }) {
  // Reading again, for another step or a cut, is often fast: delay the display, so that it does not flash.
  if (page.ready && by_id("reading").hidden) reading_delay ||= window.setTimeout(() => { by_id("reading").hidden = false; }, 400);
  else by_id("reading").hidden = false;
  by_id("reading-stage").textContent = stage ? `${stage.charAt(0).toUpperCase()}${stage.slice(1)} …` : "Reading …";
  const bar = /** @type {HTMLProgressElement} */ (by_id("reading-progress"));
  if (typeof fraction === "number") bar.value = fraction;
  else bar.removeAttribute("value");
}

function end_reading() {
  clearTimeout(reading_delay);
  reading_delay = 0;
  by_id("reading").hidden = true;
}

/** @param {{number?: number, level?: string, fraction?: number}} progress */
function show_progress({ level, fraction }) {
  sender.in_work();
  const bar = /** @type {HTMLProgressElement} */ (by_id("frame-progress"));
  bar.hidden = false;
  if (typeof fraction === "number") bar.value = fraction;
  else bar.removeAttribute("value");
  status.busy(`${level ?? "frame"}${typeof fraction === "number" ? ` ${Math.round(100 * fraction)} %` : " …"}`);
}

let reading_timer = 0;

async function load_data() {
  clearTimeout(reading_timer);
  try {
    const data = await page.ask_data();
    end_reading();
    if (start_error) messages.complain(`${start_error} The image is made without that.`, { about: "data" });
    else messages.clear("data");
    begin(data);
  } catch (error) {
    if (error instanceof StillReading) {
      show_reading(error.progress);
      reading_timer = window.setTimeout(() => void load_data(), 1000);
    } else if (error instanceof Refused) {
      show_connection("refused", { sentence: error.message });
    } else if (error instanceof Unfit && !page.ready && page.leave_out_of_start()) {
      start_error ||= sentence_of(error.message);
      void load_data();
    } else {
      end_reading();
      const sentence = start_error || (error instanceof Error ? error.message : String(error));
      if (!page.ready) page.take_start(page.whole_start);
      start_error = "";
      messages.complain(sentence, { about: "data", action: { text: "Try again", act: () => void load_data() } });
    }
  }
}
/** The reason why the file cannot be shown with the server's start options; empty if it can be shown. */
let start_error = "";

/** @param {import("./types.js").Data} data */
function begin(data) {
  if (page.ready) {
    // After reconnecting, the page requests the data of its own state again.
    known_data = "";
    ask_anew();
    return;
  }
  page.take_data(data);
  by_id("file").textContent = data.file;
  by_id("file").title = `${data.file}, ${data.format}`;
  document.title = `${data.file.replace(/^.*[\\/]/, "")} – Tessera`;
  /** @type {import("./types.js").State} */
  let state = {};
  try {
    state = state_of_fragment(location.hash) ?? {};
  } catch (error) {
    messages.complain(error instanceof Error ? error.message : String(error), { about: "link" });
  }
  page.ready = true;
  wake_controls();
  history.begin(state);
  framing.begin();
  for (const panel of panels) panel.begin();
  if (connection.is_open) sender.opened();
}

// Actions after each change.

const write_address = debounced(() => {
  const url = new URL(location.href);
  url.hash = fragment_of(history.state);
  window.history.replaceState(null, "", url);
}, 250);

let update_asked = false;
function update_soon() {
  if (update_asked) return;
  update_asked = true;
  requestAnimationFrame(() => {
    update_asked = false;
    if (!page.ready) return;
    axes.show(page.camera);
    probe.place_marker();
    // Panels are updated during a change of their own options, but not while the view turns.
    if (!history.moving || !turning) for (const panel of [functions, data_panel, view_panel, picture_panel]) panel.update();
    undo.disabled = !history.can_undo;
    redo.disabled = !history.can_redo;
  });
}
let turning = false;

history.listen(({ state, before, moving }) => {
  if (!page.ready) return;
  turning = state.camera !== before.camera;
  status.outdated(connection.is_open ? undefined : "an older image: no connection");
  if (data_words.some((word) => !same(state[word], before[word]))) probe.forget();
  const size = /^(\d+)x(\d+)$/.exec(state.size ?? "");
  if (state.size !== before.size || (size === null) !== (view.fixed === undefined)) view.fix_size(size ? { width: Number(size[1]), height: Number(size[2]) } : undefined);
  const badge = by_id("fixed-size");
  badge.hidden = size === null;
  if (size) badge.replaceChildren("fixed size ", button("Fill the window", () => history.change({ size: undefined }), { class: "plain" }));
  offer(moving);
  update_soon();
  if (!moving) {
    write_address();
    ask_anew();
  }
});

// The description of the data depends on these options.
const data_words = ["field", "time-step", "block", "smooth", "threshold", "clip"];
const data_key = () => JSON.stringify(data_words.map((word) => history.state[word] ?? null));
/** The key of the base state, with which the page began. */
let known_data = "[null,null,null,null,null,null]";
const data_question = new LatestQuestion();
const ask_anew = debounced(async () => {
  const key = data_key();
  if (!page.ready || key === known_data) return;
  known_data = key;
  // An error belongs to the state, and is reported with its picture.
  const data = await data_question.ask("api/data", { state: page.full_state() }).catch(() => undefined);
  if (!data || data.reading) return;
  page.take_data(data);
  information.begin();
  update_soon();
}, 150);

const framing = new Framing(page);
const resize_rest = debounced(() => {
  offer(false);
  write_address();
}, 250);
view.resized = () => {
  if (!page.ready) return;
  framing.follow();
  if (!view.fixed) {
    offer(true);
    resize_rest();
  }
  update_soon();
};

window.addEventListener("hashchange", () => {
  if (!page.ready || location.hash === fragment_of(history.state)) return;
  try {
    history.load(state_of_fragment(location.hash) ?? {});
  } catch (error) {
    messages.complain(error instanceof Error ? error.message : String(error), { about: "link" });
  }
});

// A background that was not chosen follows the page's colours.
dark.addEventListener("change", () => {
  offer(false);
  update_soon();
});

document.addEventListener("visibilitychange", () => {
  if (document.hidden) connection.send({ type: "pause" });
  else offer(false);
});
setInterval(() => {
  sender.tick();
  void connection.check();
}, 500);

// Keys.

/** @type {Record<string, () => void>} */
const keys = {
  f: () => void page.look("fit"), r: () => void page.look("default"), o: toggle_projection, p: () => set_probing(!probe.on),
  t: () => set_mode(modes[(modes.indexOf(mode) + 1) % modes.length]), l: () => void picture_panel.copy_link(), c: () => void picture_panel.copy_command(),
  "?": show_help, " ": () => data_panel.toggle_play(), ",": () => data_panel.step_by(-1), ".": () => data_panel.step_by(1),
  1: () => void page.look("front"), 2: () => void page.look("back"), 3: () => void page.look("left"), 4: () => void page.look("right"),
  5: () => void page.look("top"), 6: () => void page.look("bottom"), 7: () => void page.look("iso"),
};

document.addEventListener("untaken", (event) => {
  const { label, text, held } = /** @type {CustomEvent} */ (event).detail;
  messages.tell(`${label || "This value"}: "${text}" cannot be used here${held ? `; ${held} is kept` : ""}.`);
});

document.addEventListener("keydown", (event) => {
  const target = event.target instanceof Element ? event.target : document.body;
  const typing = target.matches("input:not([type=range]):not([type=checkbox]):not([type=color]), select, textarea");
  // While the user types, the browser's own undo applies.
  const half_typed = target instanceof HTMLInputElement && being_typed(target);
  if ((event.ctrlKey || event.metaKey) && !event.altKey && !half_typed && ["z", "y"].includes(event.key.toLowerCase())) {
    event.preventDefault();
    if (event.key.toLowerCase() === "y" || event.shiftKey) history.redo();
    else history.undo();
    return;
  }
  if (event.ctrlKey || event.metaKey || event.altKey || typing || event.defaultPrevented || target.closest("dialog")) return;
  if (event.key === " " && target.matches("button, summary, input, [role=button]")) return;
  const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act || !page.ready) return;
  event.preventDefault();
  act();
});

// Values for scripts and tests: what the page shows, and its latencies.
Object.assign(window, {
  tessera: {
    state: () => history.state, full_state: () => page.full_state(), shown: () => view.shown, bytes: () => view.bytes, latencies: (/** @type {boolean | undefined} */ preview) => status.latencies(preview),
    change: (/** @type {import("./types.js").State} */ state) => history.change(state), undo: () => history.undo(), link: () => picture_panel.link(), copied: () => picture_panel.copied, sent: () => sender.number,
    connection, is_answered: () => functions.is_answered,
    at_rest: () => page.ready && !history.moving && !sender.waiting && sender.number > 0 && document.body.dataset.shown === `${sender.number} exact final`,
  },
});

connection.open();
