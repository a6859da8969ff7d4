// SPDX-License-Identifier: BSD-3-Clause
/**
 * The canvas: paints frames, scales smaller ones up smoothly, and positions elements over them.
 *
 * @typedef {import("./types.js").FrameHeader} FrameHeader
 * @typedef {import("./types.js").Size} Size
 */
import { by_id } from "./dom.js";

/** The largest picture that follows the window automatically, in pixels; a larger one needs an explicit size. */
const most_pixels = 8e6;
/** While moving, the size to which a canvas is scaled up in software; the screen's scaling does the rest. */
const most_moving_pixels = 1.5e6;

/** A size of the same shape with at most `most` pixels. @param {Size} size @param {number} most @returns {Size} */
function limited({ width, height }, most) {
  const shrink = Math.min(1, Math.sqrt(most / (width * height)));
  return { width: Math.max(16, Math.floor(width * shrink)), height: Math.max(16, Math.floor(height * shrink)) };
}

export class PictureView {
  constructor() {
    this.frame = by_id("picture");
    this.canvas = /** @type {HTMLCanvasElement} */ (by_id("canvas"));
    this.context = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext("2d"));
    /** The displayed frame. @type {FrameHeader | undefined} */
    this.shown = undefined;
    /** The bytes of the displayed frame, as received. @type {Uint8Array<ArrayBuffer> | undefined} */
    this.bytes = undefined;
    this.painted = 0;
    /** The size that states request, if it does not follow the window. @type {Size | undefined} */
    this.fixed = undefined;
    /** @type {() => void} */
    this.resized = () => {};
    new ResizeObserver(() => {
      this.#lay_out();
      this.resized();
    }).observe(this.frame);
  }

  /** The window's own size in device pixels. @returns {Size} */
  window_size() {
    const box = this.frame.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    return limited({ width: Math.round(box.width * ratio), height: Math.round(box.height * ratio) }, most_pixels);
  }

  /** The size that states request. @returns {Size} */
  size() {
    return this.fixed ?? this.window_size();
  }

  /** @param {Size | undefined} size undefined: the window's */
  fix_size(size) {
    this.fixed = size;
    this.#lay_out();
  }

  /** A size in CSS pixels: fills the window, or for a fixed picture as much of it as its shape allows. */
  #lay_out() {
    const box = this.frame.getBoundingClientRect();
    const size = this.size();
    const factor = Math.min(box.width / size.width, box.height / size.height);
    this.canvas.style.width = `${this.fixed ? size.width * factor : box.width}px`;
    this.canvas.style.height = `${this.fixed ? size.height * factor : box.height}px`;
    this.frame.classList.toggle("fixed", this.fixed !== undefined);
  }

  /**
   * Paints a frame unless a later one has been painted. Resolves when it is on the screen, or would be if the page were
   * visible.
   * @param {FrameHeader} header @param {Uint8Array<ArrayBuffer>} image @returns {Promise<boolean>} whether it was painted
   */
  async paint(header, image) {
    const bitmap = await createImageBitmap(new Blob([image], { type: header.mime }), { colorSpaceConversion: "none", premultiplyAlpha: "premultiply" });
    if (!document.hidden) await new Promise((done) => requestAnimationFrame(done));
    if (header.frame < this.painted) {
      bitmap.close();
      return false;
    }
    this.painted = header.frame;
    this.shown = header;
    this.bytes = image;
    const size = header.level === "moving" ? limited(this.size(), Math.max(most_moving_pixels, header.width * header.height)) : { width: bitmap.width, height: bitmap.height };
    if (this.canvas.width !== size.width || this.canvas.height !== size.height) {
      this.canvas.width = size.width;
      this.canvas.height = size.height;
    } else {
      this.context.clearRect(0, 0, size.width, size.height);
    }
    this.context.imageSmoothingEnabled = true;
    this.context.imageSmoothingQuality = "high";
    this.context.drawImage(bitmap, 0, 0, size.width, size.height);
    bitmap.close();
    if (!document.hidden) await new Promise((done) => setTimeout(done));
    return true;
  }

  /** Must be called for a new connection, which numbers its frames from the beginning. */
  forget_numbers() {
    this.painted = 0;
  }

  /**
   * A position in the window as picture coordinates: fractions of the picture's height from its middle, y upwards.
   * @param {number} client_x @param {number} client_y
   */
  place_of(client_x, client_y) {
    const box = this.canvas.getBoundingClientRect();
    return { x: (client_x - box.left - box.width / 2) / box.height, y: -(client_y - box.top - box.height / 2) / box.height };
  }

  /** The reverse of place_of(), in CSS pixels from the frame's top left corner. @param {{x: number, y: number}} place */
  window_place(place) {
    const box = this.canvas.getBoundingClientRect(), frame = this.frame.getBoundingClientRect();
    return { left: box.left - frame.left + box.width / 2 + place.x * box.height, top: box.top - frame.top + box.height / 2 - place.y * box.height };
  }

  /** Converts picture coordinates to pixels of the picture that states request. @param {{x: number, y: number}} place */
  pixel_of(place) {
    const { width, height } = this.size();
    const inside = (/** @type {number} */ v, /** @type {number} */ most) => Math.max(0, Math.min(most - 1, Math.floor(v)));
    return { x: inside(width / 2 + place.x * height, width), y: inside(height / 2 - place.y * height, height) };
  }
}
