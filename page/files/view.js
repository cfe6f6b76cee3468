// A view of the plane that hands move and enlarge: what a canvas shows of it.

import { contextOf } from "./dom.js";
import { moved, place } from "./place.js";

/** @typedef {import("./place.js").Place} Place */

/**
 * What a canvas shows of the plane.
 * @typedef {object} View
 * @property {Place} x The middle.
 * @property {Place} y
 * @property {number} unit World units for each CSS pixel.
 * @property {number} width In CSS pixels.
 * @property {number} height
 * @property {number} ratio Device pixels for each of them.
 * @property {number[]} pixels Width and height in device pixels.
 */

/** Device pixels for each CSS pixel: as many as the screen has, two at most. */
export function fineness() {
  return Math.min(2, globalThis.devicePixelRatio || 1);
}

/** Gives a canvas a number of pixels, which empties it, unless it has that number already. */
export function sized(/** @type {HTMLCanvasElement} */ canvas, /** @type {number[]} */ [width, height]) {
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
}

/** Makes a canvas as fine as the screen, and empty. Returns its context, which draws in CSS pixels, and its size in these. */
export function fitted(/** @type {HTMLCanvasElement} */ canvas, width = canvas.clientWidth, height = canvas.clientHeight) {
  const ratio = fineness();
  sized(canvas, [width, height].map((side) => Math.round(side * ratio)));
  const context = contextOf(canvas);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** A view that is dragged and zoomed. What shows it says how far it goes, and hears of every change. */
export class Moving {
  /** @type {View} */
  view = { x: place(0), y: place(0), unit: 1, width: 1, height: 1, ratio: 1, pixels: [1, 1] };
  /** How much of the world the shorter side shows; 0 until a place is looked at. */
  span = 0;

  /** A span that can be shown. */
  bounded(/** @type {number} */ span) {
    return span;
  }

  /** A coordinate, or the last one that has points. */
  within(/** @type {Place} */ at) {
    return at;
  }

  changed() {}

  /** Takes the size of the canvas, in CSS pixels. */
  resize(/** @type {number} */ width, /** @type {number} */ height) {
    const { view } = this;
    const ratio = fineness();
    Object.assign(view, { width, height, ratio, pixels: [width, height].map((side) => Math.round(side * ratio)) });
    if (this.span) view.unit = this.span / Math.min(width, height);
    this.changed();
  }

  /** Looks at a place; `span` is how much of the world the shorter side shows. */
  lookAt(/** @type {Place} */ x, /** @type {Place} */ y, span = this.span) {
    const { view } = this;
    this.span = this.bounded(span);
    Object.assign(view, { x: this.within(x), y: this.within(y), unit: this.span / Math.min(view.width, view.height) });
    this.changed();
  }

  /** Moves by CSS pixels, as a hand moves the plane. */
  drag(/** @type {number} */ dx, /** @type {number} */ dy) {
    const { x, y, unit } = this.view;
    this.lookAt(moved(x, -dx * unit), moved(y, dy * unit));
  }

  /** Enlarges by a factor about a place on the canvas, in CSS pixels. */
  zoom(/** @type {number} */ factor, at = [this.view.width / 2, this.view.height / 2]) {
    const { x, y, unit, width, height } = this.view;
    const span = this.bounded(this.span / factor);
    const grown = unit * (1 - span / this.span);
    this.lookAt(moved(x, (at[0] - width / 2) * grown), moved(y, (height / 2 - at[1]) * grown), span);
  }
}
