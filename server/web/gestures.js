// SPDX-License-Identifier: BSD-3-Clause
/**
 * Mouse, touch and keyboard on the picture, as changes of the camera.
 *
 * @typedef {import("./types.js").Camera} Camera
 * @typedef {import("./types.js").Vector} Vector
 * @typedef {"turntable"|"trackball"|"fly"} Mode
 *
 * @typedef {object} Wiring the page's side of gestures
 * @property {() => Camera | undefined} camera the current one
 * @property {() => Vector} pole of the turntable
 * @property {() => number} extent the data's diagonal, world units
 * @property {(camera: Camera, name: string) => void} move during a gesture
 * @property {(name: string) => void} rest
 * @property {() => Mode} mode
 * @property {(x: number, y: number) => {x: number, y: number}} place_of
 * @property {(place: {x: number, y: number}) => void} pick a click in probe mode, or a long press
 * @property {(place: {x: number, y: number}) => void} centre a double click
 * @property {() => boolean} probing
 * @property {(place: {x: number, y: number}) => void} hover
 */
import { distance_of, flown, looked, panned, rolled, turned_as_ball, turned_on_table, zoomed } from "./camera.js";

/** Milliseconds without an event after which a wheel or key gesture ends. */
const rest_time = 180;
/** A press that moves by fewer CSS pixels is not a drag. */
const slack = 4;
const long_press = 600;
const turn_step = 5 / 180;

export class Gestures {
  /** @param {HTMLElement} surface @param {Wiring} wiring */
  constructor(surface, wiring) {
    this.surface = surface;
    this.wiring = wiring;
    /** @type {Map<number, {x: number, y: number}>} */
    this.pointers = new Map();
    this.button = 0;
    this.travelled = 0;
    this.rest_timer = 0;
    this.press_timer = 0;
    /** The flight keys that are pressed. @type {Set<string>} */
    this.held = new Set();
    this.flying = false;
    surface.addEventListener("pointerdown", (e) => this.#press(e));
    surface.addEventListener("pointermove", (e) => this.#drag(e));
    for (const end of ["pointerup", "pointercancel"]) surface.addEventListener(end, (e) => this.#release(/** @type {PointerEvent} */ (e)));
    surface.addEventListener("wheel", (e) => this.#wheel(e), { passive: false });
    surface.addEventListener("contextmenu", (e) => e.preventDefault());
    surface.addEventListener("dblclick", (e) => over_the_picture(e) || wiring.centre(wiring.place_of(e.clientX, e.clientY)));
    surface.addEventListener("keydown", (e) => this.#key(e));
    surface.addEventListener("keyup", (e) => {
      this.held.delete(e.code);
    });
    surface.addEventListener("blur", () => this.held.clear());
  }

  /** @param {(camera: Camera) => Camera} change @param {string} name */
  #move(change, name) {
    const camera = this.wiring.camera();
    if (camera) this.wiring.move(change(camera), name);
  }

  /** @param {string} name */
  #rest_soon(name) {
    clearTimeout(this.rest_timer);
    this.rest_timer = window.setTimeout(() => this.wiring.rest(name), rest_time);
  }

  /** @param {PointerEvent} event */
  #press(event) {
    if (over_the_picture(event)) return;
    this.surface.focus({ preventScroll: true });
    this.surface.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.button = event.button;
    if (this.pointers.size === 1) this.travelled = 0;
    clearTimeout(this.press_timer);
    if (event.pointerType === "touch" && this.pointers.size === 1)
      this.press_timer = window.setTimeout(() => {
        if (this.travelled < slack) this.wiring.pick(this.wiring.place_of(event.clientX, event.clientY));
      }, long_press);
    if (event.button === 1) event.preventDefault();
  }

  /** @param {PointerEvent} event */
  #drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === "mouse") this.wiring.hover(this.wiring.place_of(event.clientX, event.clientY));
      return;
    }
    const after = { x: event.clientX, y: event.clientY };
    this.travelled += Math.hypot(after.x - before.x, after.y - before.y);
    if (this.travelled < slack) return;
    clearTimeout(this.press_timer);
    if (this.pointers.size >= 2) this.#pinch(event.pointerId, after);
    else this.#drag_one(before, after, event);
    this.pointers.set(event.pointerId, after);
  }

  /** @param {{x: number, y: number}} before @param {{x: number, y: number}} after @param {PointerEvent} event */
  #drag_one(before, after, event) {
    const a = this.wiring.place_of(before.x, before.y), b = this.wiring.place_of(after.x, after.y);
    const dx = b.x - a.x, dy = b.y - a.y;
    if (this.button === 1 || this.button === 2 || event.shiftKey) return this.#move((c) => panned(c, dx, dy), "drag");
    if (event.ctrlKey || event.metaKey) {
      const angle = Math.atan2(a.y, a.x) - Math.atan2(b.y, b.x);
      return this.#move((c) => rolled(c, Math.atan2(Math.sin(angle), Math.cos(angle))), "drag");
    }
    this.#move((c) => this.#turned(c, dx, dy), "drag");
  }

  /** @param {Camera} camera @param {number} dx @param {number} dy */
  #turned(camera, dx, dy) {
    const mode = this.wiring.mode();
    if (mode === "fly") return looked(camera, dx, dy);
    return mode === "trackball" ? turned_as_ball(camera, dx, dy) : turned_on_table(camera, dx, dy, this.wiring.pole());
  }

  /** Handles two fingers: the points that they touch stay under the fingers. @param {number} id @param {{x: number, y: number}} after */
  #pinch(id, after) {
    const [first, second] = [...this.pointers.keys()];
    const other_id = id === first ? second : first;
    const before = this.pointers.get(id), other = this.pointers.get(other_id);
    if (!before || !other || (id !== first && id !== second)) return;
    const place = (/** @type {{x: number, y: number}} */ p) => this.wiring.place_of(p.x, p.y);
    const [a, b, still] = [place(before), place(after), place(other)];
    const was = { x: a.x - still.x, y: a.y - still.y }, is = { x: b.x - still.x, y: b.y - still.y };
    const factor = Math.hypot(is.x, is.y) / Math.max(1e-6, Math.hypot(was.x, was.y));
    const angle = Math.atan2(was.y, was.x) - Math.atan2(is.y, is.x);
    const middle = { x: (b.x + still.x) / 2, y: (b.y + still.y) / 2 };
    this.#move((camera) => {
      let moved = panned(camera, (b.x - a.x) / 2, (b.y - a.y) / 2);
      moved = zoomed(moved, factor, middle.x, middle.y);
      return this.wiring.mode() === "trackball" ? rolled(moved, Math.atan2(Math.sin(angle), Math.cos(angle))) : moved;
    }, "pinch");
  }

  /** @param {PointerEvent} event */
  #release(event) {
    clearTimeout(this.press_timer);
    if (!this.pointers.delete(event.pointerId) || this.pointers.size > 0) return;
    if (this.travelled < slack && event.type === "pointerup" && event.button === 0) {
      if (this.wiring.probing() || event.altKey) this.wiring.pick(this.wiring.place_of(event.clientX, event.clientY));
    } else {
      this.wiring.rest("");
    }
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    if (over_the_picture(event)) return;
    event.preventDefault();
    const unit = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 18 : event.deltaMode === WheelEvent.DOM_DELTA_PAGE ? 200 : 1;
    const amount = Math.max(-300, Math.min(300, event.deltaY * unit * (event.ctrlKey ? 4 : 1)));
    const place = this.wiring.place_of(event.clientX, event.clientY);
    if (this.wiring.mode() === "fly")
      this.#move((c) => flown(c, [0, 0, (-amount / 400) * this.#stride(c)]), "wheel");
    else this.#move((c) => zoomed(c, Math.exp(-amount / 400), place.x, place.y), "wheel");
    this.#rest_soon("wheel");
  }

  /** Speed of flight per second: proportional to the distance of the focal point, but never close to zero. @param {Camera} camera */
  #stride(camera) {
    return Math.min(this.wiring.extent(), Math.max(0.15 * this.wiring.extent(), 0.5 * distance_of(camera)));
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (this.wiring.mode() === "fly" && flight_keys.has(event.code)) {
      event.preventDefault();
      this.held.add(event.code);
      if (!this.flying) this.#fly();
      return;
    }
    const step = camera_keys[event.key];
    if (!step) return;
    event.preventDefault();
    const fine = event.shiftKey;
    this.#move((camera) => step(camera, { fine, turned: (dx, dy) => this.#turned(camera, dx, dy) }), "keys");
    this.#rest_soon("keys");
  }

  /** Moves the camera in every frame of the screen while keys are pressed. */
  #fly() {
    this.flying = true;
    let last = performance.now();
    const advance = (/** @type {number} */ now) => {
      if (this.held.size === 0) {
        this.flying = false;
        this.wiring.rest("flight");
        return;
      }
      const seconds = Math.min(0.1, Math.max(0, now - last) / 1000);
      last = now;
      /** @type {Vector} */
      const by = [0, 0, 0];
      for (const code of this.held) {
        const [axis, sign] = flight_keys.get(code) ?? [0, 0];
        by[axis] += sign;
      }
      this.#move((c) => flown(c, /** @type {Vector} */ (by.map((v) => v * seconds * this.#stride(c)))), "flight");
      requestAnimationFrame(advance);
    };
    requestAnimationFrame(advance);
  }
}

/** Whether an event belongs to an element over the picture: tools, messages. @param {Event} event */
const over_the_picture = (event) => event.target instanceof Element && event.target.closest("[data-over]") !== null;

/** By the key's position on the keyboard: axis (right, up, forward) and sign. @type {Map<string, [number, number]>} */
const flight_keys = new Map([["KeyW", [2, 1]], ["KeyS", [2, -1]], ["KeyA", [0, -1]], ["KeyD", [0, 1]], ["KeyE", [1, 1]], ["KeyQ", [1, -1]]]);

/**
 * @typedef {{fine: boolean, turned: (dx: number, dy: number) => Camera}} Step
 * @type {Record<string, (camera: Camera, step: Step) => Camera>}
 */
const camera_keys = {
  ArrowLeft: (c, { fine, turned }) => (fine ? panned(c, 0.05, 0) : turned(-turn_step, 0)),
  ArrowRight: (c, { fine, turned }) => (fine ? panned(c, -0.05, 0) : turned(turn_step, 0)),
  ArrowUp: (c, { fine, turned }) => (fine ? panned(c, 0, -0.05) : turned(0, turn_step)),
  ArrowDown: (c, { fine, turned }) => (fine ? panned(c, 0, 0.05) : turned(0, -turn_step)),
  "+": (c) => zoomed(c, 1.15),
  "=": (c) => zoomed(c, 1.15),
  "-": (c) => zoomed(c, 1 / 1.15),
  PageUp: (c) => zoomed(c, 1.5),
  PageDown: (c) => zoomed(c, 1 / 1.5),
  "[": (c) => rolled(c, -turn_step * Math.PI),
  "]": (c) => rolled(c, turn_step * Math.PI),
};
