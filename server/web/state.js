// SPDX-License-Identifier: BSD-3-Clause
/**
 * The state of the page and its history. Undo and redo go from one state at rest to the next: all changes while a
 * control is dragged, or while one control is used repeatedly, make one step.
 *
 * @typedef {import("./types.js").State} State
 * @typedef {object} Change
 * @property {State} state
 * @property {State} before
 * @property {boolean} moving more changes follow
 * @property {"change"|"cancel"|"undo"|"redo"|"load"|"adjust"} cause
 */

/** Largest number of steps that are kept. */
const most_steps = 500;
/** Changes with the same name within this time, in milliseconds, are one step. */
const merge_time = 900;

/** Whether two values are equal when converted to JSON. @param {any} a @param {any} b */
export const same = (a, b) => a === b || JSON.stringify(a) === JSON.stringify(b);

/** Returns the state without keys whose values are empty. @param {State} state @returns {State} */
const tidied = (state) => Object.fromEntries(Object.entries(state).filter(([, value]) => value !== undefined && !(Array.isArray(value) && value.length === 0)));

export class StateHistory {
  /** @param {State} [state] @param {() => number} [clock] milliseconds */
  constructor(state = {}, clock = () => performance.now()) {
    this.state = tidied(state);
    this.moving = false;
    this.clock = clock;
    /** @type {State} */
    this.at_rest = this.state;
    /** @type {State[]} */
    this.undone = [];
    /** @type {State[]} */
    this.done = [];
    this.last_name = "";
    this.last_time = -Infinity;
    /** @type {Set<(change: Change) => void>} */
    this.listeners = new Set();
  }

  /** Calls `listener` after each change. Returns a function that removes it. @param {(change: Change) => void} listener */
  listen(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /**
   * Sets keys; undefined removes one. `moving`: more changes follow, until settle(). `name`: consecutive changes with
   * the same name are one step.
   * @param {State} keys @param {{moving?: boolean, name?: string}} [how]
   */
  change(keys, how = {}) {
    const before = this.state;
    const after = tidied({ ...before, ...keys });
    const moving = how.moving ?? false;
    if (same(before, after) && moving === this.moving) return;
    this.state = after;
    this.moving = moving;
    if (!moving) this.#remember(how.name ?? "");
    this.#tell({ state: after, before, moving, cause: "change" });
  }

  /** Ends a movement. @param {string} [name] as in change() */
  settle(name = "") {
    if (!this.moving) return;
    this.moving = false;
    this.#remember(name);
    this.#tell({ state: this.state, before: this.state, moving: false, cause: "change" });
  }

  /** Reverts a movement to the state at rest. */
  cancel() {
    if (!this.moving) return;
    const before = this.state;
    this.state = this.at_rest;
    this.moving = false;
    this.#tell({ state: this.state, before, moving: false, cause: "cancel" });
  }

  /** Replaces the state, as one step. @param {State} state */
  load(state) {
    const before = this.state;
    this.state = tidied(state);
    this.moving = false;
    this.#remember("");
    this.#tell({ state: this.state, before, moving: false, cause: "load" });
  }

  /**
   * Sets keys that follow the window, which undo does not revert: steps with the same values as the state change too.
   * @param {State} keys
   */
  adjust(keys) {
    const before = this.state;
    const adjusted = (/** @type {State} */ state) => tidied({ ...state, ...Object.fromEntries(Object.entries(keys).filter(([key]) => same(state[key], before[key]))) });
    this.state = adjusted(before);
    this.at_rest = adjusted(this.at_rest);
    this.done = this.done.map(adjusted);
    this.undone = this.undone.map(adjusted);
    this.#tell({ state: this.state, before, moving: true, cause: "adjust" });
  }

  /** Sets the page's initial state, which cannot be undone. @param {State} state */
  begin(state) {
    const before = this.state;
    this.state = this.at_rest = tidied(state);
    this.moving = false;
    this.#tell({ state: this.state, before, moving: false, cause: "load" });
  }

  get can_undo() {
    return this.done.length > 0 || !same(this.state, this.at_rest);
  }
  get can_redo() {
    return this.undone.length > 0;
  }

  undo() {
    this.settle();
    this.#step(this.done, this.undone, "undo");
  }
  redo() {
    this.settle();
    this.#step(this.undone, this.done, "redo");
  }

  /** @param {State[]} from @param {State[]} to @param {"undo"|"redo"} cause */
  #step(from, to, cause) {
    const state = from.pop();
    if (!state) return;
    const before = this.state;
    to.push(this.at_rest);
    this.state = this.at_rest = state;
    this.last_name = "";
    this.#tell({ state, before, moving: false, cause });
  }

  /** @param {string} name */
  #remember(name) {
    if (same(this.state, this.at_rest)) return;
    const now = this.clock();
    const merged = name !== "" && name === this.last_name && now - this.last_time < merge_time && this.done.length > 0;
    if (!merged) this.done.push(this.at_rest);
    if (this.done.length > most_steps) this.done.shift();
    this.undone = [];
    this.at_rest = this.state;
    [this.last_name, this.last_time] = [name, now];
  }

  /** @param {Change} change */
  #tell(change) {
    for (const listener of this.listeners) listener(change);
  }
}
