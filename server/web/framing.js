// SPDX-License-Identifier: BSD-3-Clause
/**
 * Keeps the visible scene in the picture when its shape changes, for example by the panel on a phone: a camera defines
 * the visible height, so a narrower picture would be cut at its sides.
 *
 * @typedef {import("./page.js").Page} Page
 * @typedef {import("./types.js").Camera} Camera
 */
import { zoomed } from "./camera.js";

export class Framing {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    /** Width over height of the window that the picture fills. */
    this.shape = 0;
    /** The chosen camera, and the picture's shape at that time: with this shape, that camera is restored. @type {{ camera: Camera, shape: number } | undefined} */
    this.chosen = undefined;
    /** The adjusted camera. @type {Camera | undefined} */
    this.made = undefined;
  }

  get #shape_now() {
    const { width, height } = this.page.view.window_size();
    return width / height;
  }

  /** Must be called when the data are available and the camera has been made for the picture's shape. */
  begin() {
    this.shape = this.#shape_now;
  }

  /** Must be called when the picture's shape has changed. */
  follow() {
    const { page } = this;
    const before = this.shape;
    this.shape = this.#shape_now;
    if (page.history.moving || page.view.fixed || this.shape === before) return;
    if (!this.chosen || page.camera !== this.made) this.chosen = { camera: page.camera, shape: before };
    const shrink = Math.min(1, this.shape / this.chosen.shape);
    this.made = shrink < 1 ? zoomed(this.chosen.camera, shrink) : this.chosen.camera;
    if (this.made !== page.camera) page.history.adjust({ camera: this.made });
  }
}
