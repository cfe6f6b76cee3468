// Sheets, painted once and shown in many frames: a sheet is larger than the canvas, so that a drag
// only moves it. The one before stays underneath until the next one is full.

import { chunkSize, chunksOf, cornerFrom, grayOf, shareFor } from "./grid.js";
import { runsOf } from "./chunks.js";
import { isColored, sizesOf, tonesOf } from "./marks.js";
import { distance } from "./place.js";

/** How much larger than the canvas a sheet is, on each side, as a share of the canvas. */
const MARGIN = 0.2;
/** The time that painting points may take of a frame, in milliseconds. */
const PATIENCE = 6;
/** How far a zoom may stretch a sheet while it goes on. */
const STRETCH = 1.6;
/** How much of the ground the densest layer covers where density is drawn as gray. */
export const GRAY = 0.55;

/**
 * Hears of a point: its layer, where it is as seen from the middle of a view, and its chunk and number there.
 * @typedef {(layer: number, x: number, y: number, chunk: import("./chunks.js").Chunk, k: number) => void} Visit
 */

export class Sheets {
  constructor(painter, chunks) {
    this.painter = painter;
    this.chunks = chunks;
    /** @type {any} */
    this.front = null;
    /** @type {any} */
    this.back = null;
    /** @type {any} */
    this.spare = null;
    this.blank = false;
  }

  /** Forgets what is painted: the next frame begins anew, with the old underneath if it still fits. */
  renew(keepsBack) {
    if (this.front) this.front.isStale = true;
    if (!keepsBack) this.blank = true;
  }

  /** Paints what has come, and shows it; returns whether there is more to do in the next frame. */
  frame(view, look, isZooming) {
    const { painter } = this;
    if (!this.fits(view, isZooming)) this.begin(view, look);
    const missing = this.fill(look);
    painter.begin(look.ground);
    const shown = this.placed(this.front, view);
    painter.show(this.front.surface, shown);
    if (this.back) {
      if (missing.length === 0) this.drop("back");
      else this.underneath(view, missing);
    }
    const isSharp = this.front.unit === view.unit;
    return missing.length > 0 && missing.some(({ chunk, done }) => done < chunk.count) || (!isSharp && !isZooming);
  }

  /** Whether the front sheet still serves a view. */
  fits(view, isZooming) {
    const { front } = this;
    if (!front || front.isStale) return false;
    const scale = front.unit / view.unit;
    if (scale !== 1 && (!isZooming || scale > STRETCH || scale < 1 / STRETCH)) return false;
    if (front.canvas[0] !== view.pixels[0] || front.canvas[1] !== view.pixels[1]) return false;
    const spare = [0, 1].map((i) => (front.surface[["width", "height"][i]] * scale - view.pixels[i]) / 2);
    const { x, y } = this.placed(front, view);
    return Math.abs(x) <= Math.max(1, spare[0]) && Math.abs(y) <= Math.max(1, spare[1]);
  }

  /** Where a sheet is on the canvas, in device pixels. */
  placed(sheet, view) {
    const pixel = view.unit / view.ratio;
    return {
      x: Math.round(distance(sheet.x, view.x) / pixel),
      y: Math.round(distance(sheet.y, view.y) / pixel),
      scale: sheet.unit / view.unit,
    };
  }

  /** Begins a sheet around the view. */
  begin(view, look) {
    const { painter, front } = this;
    if (front && !this.blank && (!this.back || front.isFull)) {
      if (this.back) this.drop("back");
      this.back = front;
    } else if (front) this.drop("front");
    if (this.blank && this.back) this.drop("back");
    this.blank = false;
    const [width, height] = view.pixels.map((side) => {
      const wanted = Math.ceil(side * (1 + 2 * MARGIN));
      return Math.min(painter.most, wanted + (wanted % 2));
    });
    const surface = this.surface(width, height);
    const gray = grayOf(view, look.spacings);
    const ground = mixed(look.ground, grounded(look), gray);
    painter.clear(surface, ground, look.layers);
    const { x, y, unit, ratio } = view;
    const wide = { x, y, unit, width: width / ratio, height: height / ratio };
    const size = chunkSize(view, look.spacing);
    const keep = shareFor(view, look.spacings);
    const wanted = this.chunks.want(gray === 1 ? [] : chunksOf(wide, size), keep);
    this.front = {
      surface, x, y, unit, ratio, size, keep, gray, canvas: [...view.pixels],
      colors: look.colors.map((color) => mixed(color, ground, gray)),
      parts: wanted.map((chunk) => ({ chunk, done: 0, isWhole: false })),
      isFull: false, isStale: false,
    };
  }

  /** Paints arrived points, up to a frame's budget; returns the parts that are not whole. */
  fill(look) {
    const { front, painter } = this;
    const end = performance.now() + PATIENCE;
    let budget = painter.budget;
    for (const part of front.parts) {
      const { chunk } = part;
      if (part.done > chunk.count) part.done = 0;
      while (part.done < chunk.count && budget > 0 && performance.now() < end) {
        const until = Math.min(chunk.count, part.done + painter.slice);
        budget -= until - part.done;
        this.paint(part, until, look);
        part.done = until;
      }
      part.isWhole = chunk.state === "done" && part.done === chunk.count;
    }
    painter.flush(front.surface);
    const missing = front.parts.filter((part) => !part.isWhole);
    front.isFull = missing.length === 0;
    return missing;
  }

  paint(part, until, look) {
    const { front, painter } = this;
    const { chunk } = part;
    const pixel = front.unit / front.ratio;
    const corner = [cornerFrom(chunk.cx, chunk.size, front.x) / pixel, cornerFrom(chunk.cy, chunk.size, front.y) / pixel];
    front.sizes ??= sizesOf(look.layers, look.spacings.map((spacing) => spacing / Math.sqrt(front.keep)), front.unit);
    for (const run of runsOf(chunk)) {
      const first = Math.max(run.first, part.done);
      const count = Math.min(run.first + run.count, until) - first;
      if (count <= 0) continue;
      const layer = look.layers[run.layer];
      const tones = isColored(layer) ? tonesOf(look.layers, run.layer, front.colors) : null;
      painter.paint(front.surface, chunk, {
        layer, first, count, corner, zoom: 1 / pixel, size: front.sizes[run.layer] * front.ratio, color: front.colors[layer.color], tones,
      });
    }
  }

  /** Shows the sheet before where the front one still misses chunks. */
  underneath(view, missing) {
    const pixel = view.unit / view.ratio;
    const [width, height] = view.pixels;
    const placed = this.placed(this.back, view);
    for (const { chunk } of missing) {
      const from = [cornerFrom(chunk.cx, chunk.size, view.x), cornerFrom(chunk.cy, chunk.size, view.y)];
      const low = from.map((v, i) => Math.max(0, Math.round(v / pixel + view.pixels[i] / 2)));
      const high = from.map((v, i) => Math.min([width, height][i], Math.round((v + chunk.size) / pixel + view.pixels[i] / 2)));
      if (high[0] <= low[0] || high[1] <= low[1]) continue;
      this.painter.show(this.back.surface, { ...placed, rect: [low[0], low[1], high[0] - low[0], high[1] - low[1]] });
    }
  }

  /** Calls `visit` for the points of a box of half sides around a place, which is seen from the middle of a view. */
  around(view, /** @type {number[]} */ [middleX, middleY], /** @type {number[]} */ [halfX, halfY], /** @type {Visit} */ visit) {
    for (const { chunk } of this.front?.parts ?? []) {
      const [left, low] = [cornerFrom(chunk.cx, chunk.size, view.x), cornerFrom(chunk.cy, chunk.size, view.y)];
      const [toX, toY] = [left - middleX, low - middleY];
      if (toX > halfX || toY > halfY || toX + chunk.size < -halfX || toY + chunk.size < -halfY) continue;
      for (const { layer, first, count } of runsOf(chunk)) {
        for (let k = first; k < first + count; k += 1) {
          const x = left + chunk.data[k * chunk.stride];
          const y = low + chunk.data[k * chunk.stride + 1];
          if (x - middleX >= -halfX && x - middleX < halfX && y - middleY >= -halfY && y - middleY < halfY) visit(layer, x, y, chunk, k);
        }
      }
    }
  }

  /** A surface, the one that was used last if it fits. */
  surface(width, height) {
    const { spare } = this;
    this.spare = null;
    if (spare && spare.width === width && spare.height === height) return spare;
    if (spare) this.painter.drop(spare);
    return this.painter.sheet(width, height);
  }

  drop(name) {
    if (!this[name]) return;
    if (this.spare) this.painter.drop(this.spare);
    this.spare = this[name].surface;
    this[name] = null;
  }
}

/** A color on its way to another one. */
function mixed(from, to, share) {
  return from.map((v, c) => v + (to[c] - v) * share);
}

/** The ground under layers that are too dense for points: those everywhere mix their colors into it. */
function grounded({ ground, colors, layers, spacings }) {
  const nearest = Math.min(...spacings);
  return layers.reduce((mix, layer, i) => mixed(mix, colors[layer.color], layer.field ? 0 : (GRAY * nearest) / spacings[i]), ground);
}
