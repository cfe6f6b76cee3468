// The view of the plane: where it is, how it moves, and the loop that paints it.

import { chunkSize, farthest, isTooFar } from "./grid.js";
import { Chunks } from "./chunks.js";
import { framed } from "./dom.js";
import { Painter } from "./painter.js";
import { moved, place, toNumber } from "./place.js";
import { Sheets } from "./sheets.js";
import { Moving, sized } from "./view.js";

/** A view shows at least half a spacing, and at most this number of spacings: hundreds of millions of points, drawn as gray. */
const LEAST_SPAN = 0.5;
const MOST_SPAN = 2e4;
/** A zoom counts as over after this time, in milliseconds. */
const REST = 140;

/** @typedef {import("./place.js").Place} Place */
/** @typedef {import("./chunks.js").Chunk} Chunk */

/**
 * What is shown, and in which colors: red, green and blue from 0 to 1.
 * @typedef {object} Look
 * @property {import("./state.js").Layer[]} layers
 * @property {number[]} spacings The mean spacing of each layer.
 * @property {number[][]} colors
 * @property {number[]} ground
 */

/**
 * What a plane reports.
 * @typedef {object} Events
 * @property {() => void} moved The view has changed.
 * @property {(share: number) => void} progress A share of what is in view has arrived.
 * @property {() => void} settled All in view is painted.
 * @property {(error: Error) => void} failed
 */

/** A canvas that shows the points of some layers. */
export class Plane extends Moving {
  constructor(/** @type {HTMLCanvasElement} */ canvas, /** @type {Events} */ events) {
    super();
    this.events = events;
    this.painter = new Painter(canvas);
    this.canvas = canvas;
    this.chunks = new Chunks(() => this.draw(), events.failed);
    this.sheets = new Sheets(this.painter, this.chunks);
    /** @type {Look & { spacing: number } | null} */
    this.look = null;
    this.draw = framed(() => this.paint());
    this.zoomedAt = -Infinity;
    new ResizeObserver(() => canvas.clientWidth && canvas.clientHeight && this.resize(canvas.clientWidth, canvas.clientHeight)).observe(canvas);
  }

  changed() {
    sized(this.canvas, this.view.pixels);
    this.draw();
    this.events.moved();
  }

  /** Says what is shown: the layers with their spacings, colors and the color of the ground. */
  show(/** @type {Look} */ look) {
    const isNew = this.look === null;
    const before = this.chunks.identity;
    this.look = { ...look, spacing: Math.min(...look.spacings) };
    this.chunks.show(look.layers);
    this.sheets.renew(!isNew && before === this.chunks.identity);
    this.draw();
  }

  /** @param {number} span */
  bounded(span) {
    const spacing = this.look?.spacing;
    if (!spacing) return span;
    return Math.min(MOST_SPAN * spacing, Math.max(LEAST_SPAN * spacing, span));
  }

  /** A coordinate, or the last one that has points. */
  within(/** @type {Place} */ at) {
    if (!this.look) return at;
    const most = farthest(this.look.spacing);
    return Math.abs(toNumber(at)) > most ? place(Math.sign(toNumber(at)) * most) : at;
  }

  /** @param {number} factor */
  zoom(factor, at = [this.view.width / 2, this.view.height / 2]) {
    this.zoomedAt = performance.now();
    super.zoom(factor, at);
  }

  /** One frame. */
  paint(isMeasured = false) {
    if (!this.look || !this.span) return;
    const began = performance.now();
    const isZooming = began - this.zoomedAt < REST;
    const hasMore = this.sheets.frame(this.view, this.look, isZooming);
    if (isMeasured) this.painter.finish();
    this.cost = performance.now() - began;
    if (hasMore || isZooming) this.draw();
    const { progress } = this.chunks;
    this.events.progress(progress);
    if (this.sheets.front.isFull && !isZooming && this.sheets.front.unit === this.view.unit) this.events.settled();
  }

  /** Whether a place is too far out for numbers to tell points apart. */
  isTooFar(/** @type {{ x: Place, y: Place }} */ at) {
    return this.look !== null && isTooFar(at, this.look.spacing);
  }

  /** The share of the points that is shown; all of them where none is drawn. */
  get keep() {
    return this.isGray ? 1 : this.sheets.front?.keep ?? 1;
  }

  /** How far points have faded into gray, which shows density where there are too many: 0 to 1. */
  get gray() {
    return this.sheets.front?.gray ?? 0;
  }

  /** Whether density is drawn as gray, in place of points. */
  get isGray() {
    return this.gray === 1;
  }

  /** How large a chunk is here. */
  get chunkSize() {
    return chunkSize(this.view, this.look?.spacing ?? 1);
  }

  /** Visits the points in view and up to `margin` around it, as `Sheets.around`. */
  each(/** @type {import("./sheets.js").Visit} */ visit, margin = 0) {
    const { width, height, unit } = this.view;
    this.sheets.around(this.view, [0, 0], [(width * unit) / 2 + margin, (height * unit) / 2 + margin], visit);
  }

  /** The point nearest to a place on the canvas, if it is within a distance in CSS pixels. */
  pointAt(/** @type {[number, number]} */ [px, py], /** @type {number} */ within) {
    const { view } = this;
    const at = [(px - view.width / 2) * view.unit, (view.height / 2 - py) * view.unit];
    const reach = within * view.unit;
    let [best, nearest] = [/** @type {{ chunk: Chunk, k: number } | null} */ (null), reach];
    this.sheets.around(view, at, [reach, reach], (_, x, y, chunk, k) => {
      const away = Math.hypot(x - at[0], y - at[1]);
      if (away <= nearest) [best, nearest] = [{ chunk, k }, away];
    });
    return best && this.pointOf(best.chunk, best.k);
  }

  /** A point of a chunk: its layer and where it is. */
  pointOf(/** @type {Chunk} */ chunk, /** @type {number} */ k) {
    const { data, stride } = chunk;
    const layer = chunk.columns[0] === "layer" ? data[k * stride + 2] : 0;
    const at = (/** @type {number} */ index, /** @type {number} */ offset) => moved(place(index * chunk.size, 0), offset);
    return { layer, x: at(chunk.cx, data[k * stride]), y: at(chunk.cy, data[k * stride + 1]) };
  }
}
