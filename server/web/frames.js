// SPDX-License-Identifier: BSD-3-Clause
/**
 * The stream of frames: their format, and when states are sent.
 *
 * @typedef {import("./types.js").FrameHeader} FrameHeader
 * @typedef {import("./types.js").State} State
 */

/** Largest length of a valid header. */
const most_header = 1 << 20;

/**
 * Decodes a frame's header and picture. Throws an Error, whose message is a sentence, for invalid bytes.
 * @param {ArrayBuffer} bytes @returns {{header: FrameHeader, image: Uint8Array<ArrayBuffer>}}
 */
export function decoded_frame(bytes) {
  const length = bytes.byteLength >= 4 ? new DataView(bytes).getUint32(0, true) : Infinity;
  if (length > most_header || length + 4 > bytes.byteLength) throw new Error("The server sent a frame that cannot be read; reload the page.");
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { header, image: new Uint8Array(bytes, 4 + length) };
}

/**
 * Decides which states are sent: while something moves, one at a time, the latest, as soon as the previous one has been
 * painted; a state at rest immediately, as it cancels current work. Stops waiting for an answer after `patience`.
 */
export class StateSender {
  /**
   * @param {(message: {type: "state", number: number, moving: boolean, state: State}) => void} send
   * @param {{patience?: number, clock?: () => number}} [how]
   */
  constructor(send, { patience = 5000, clock = () => performance.now() } = {}) {
    this.send = send;
    this.patience = patience;
    this.clock = clock;
    this.number = 0;
    this.awaited = 0;
    this.sent_at = 0;
    this.open = false;
    /** @type {{state: State, moving: boolean, time: number} | undefined} */
    this.waiting = undefined;
    /** @type {{state: State, moving: boolean, time: number} | undefined} */
    this.latest = undefined;
    /** For each number of a state, the time of the event that caused the state. @type {Map<number, number>} */
    this.event_times = new Map();
  }

  /** @param {State} state @param {boolean} moving @param {number} [time] of the event that made it */
  offer(state, moving, time = this.clock()) {
    this.waiting = this.latest = { state, moving, time };
    this.#advance();
  }

  /** Must be called when a painted picture or an error has answered state `number`. @param {number} number */
  answered(number) {
    if (number < this.awaited) return;
    this.awaited = 0;
    this.#advance();
  }

  /** Must be called when the server reports that the answer is in progress. */
  in_work() {
    this.sent_at = this.clock();
  }

  /** Sends the latest state. Must be called for a new connection. */
  opened() {
    this.open = true;
    this.awaited = 0;
    if (this.latest) this.waiting = { ...this.latest, moving: false, time: this.clock() };
    this.#advance();
  }

  closed() {
    this.open = false;
  }

  /** Stops waiting for answers that do not arrive. Must be called periodically. */
  tick() {
    if (this.awaited && this.clock() - this.sent_at > this.patience) this.awaited = 0;
    this.#advance();
  }

  #advance() {
    const next = this.waiting;
    if (!this.open || !next || (this.awaited && next.moving)) return;
    this.waiting = undefined;
    this.awaited = ++this.number;
    this.sent_at = this.clock();
    this.event_times.set(this.number, next.time);
    for (const number of this.event_times.keys()) if (number < this.number - 50) this.event_times.delete(number);
    this.send({ type: "state", number: this.number, moving: next.moving, state: next.state });
  }
}

/** Delay in milliseconds before connection attempt `tries` (from 0): half a second, doubled up to 15 s, and up to a quarter more. @param {number} tries @param {number} [random] 0 to 1 */
export const back_off = (tries, random = Math.random()) => Math.min(15000, 500 * 2 ** tries) * (1 + random / 4);

/** The median and the 95 % quantile. @param {number[]} values */
export function median_and_95(values) {
  const sorted = values.slice().sort((a, b) => a - b);
  const at = (/** @type {number} */ part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] ?? Number.NaN;
  return { count: sorted.length, median: at(0.5), p95: at(0.95) };
}
