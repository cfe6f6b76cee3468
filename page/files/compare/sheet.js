// The picture of one panel: points are painted once on a sheet larger than the canvas, which a drag only moves.

import { contextOf } from "../dom.js";
import { dotSize } from "../marks.js";
import { distance } from "../place.js";
import { themeColor } from "../theme.js";
import { sized } from "../view.js";

/** How much larger than the canvas the sheet is, on each side, as a share of the canvas. */
const MARGIN = 0.3;

/** A dot on a canvas of its own: painting it again and again is faster than drawing circles. */
function dotOf(size, color) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = Math.ceil(size) + 2;
  const context = contextOf(canvas);
  context.fillStyle = color;
  context.beginPath();
  context.arc(canvas.width / 2, canvas.width / 2, size / 2, 0, 2 * Math.PI);
  context.fill();
  return canvas;
}

export class Sheet {
  /** `box` is the region of a method that has one. */
  constructor(canvas, box) {
    this.canvas = canvas;
    this.box = box;
    this.sheet = document.createElement("canvas");
    this.ground = "";
    /** @type {any} */
    this.held = null;
  }

  /** Forgets what is painted: the theme or the points are others. */
  renew() {
    this.held = null;
  }

  draw(view, source) {
    const { canvas, held } = this;
    const [width, height] = view.pixels;
    sized(canvas, view.pixels);
    if (!held || held.version !== source.version || !this.fits(view)) this.paint(view, source);
    const pixel = view.unit / view.ratio;
    const context = contextOf(canvas);
    const [x, y] = [distance(this.held.x, view.x) / pixel, -distance(this.held.y, view.y) / pixel];
    context.fillStyle = this.ground;
    context.fillRect(0, 0, width, height);
    context.drawImage(this.sheet, Math.round(width / 2 + x - this.sheet.width / 2), Math.round(height / 2 + y - this.sheet.height / 2));
    if (this.box) this.edge(context, view);
  }

  fits(view) {
    const { held } = this;
    if (held.unit !== view.unit || held.pixels.join() !== view.pixels.join()) return false;
    const pixel = view.unit / view.ratio;
    return Math.abs(distance(held.x, view.x) / pixel) <= MARGIN * view.pixels[0]
      && Math.abs(distance(held.y, view.y) / pixel) <= MARGIN * view.pixels[1];
  }

  paint(view, source) {
    const { x, y, unit, ratio, pixels } = view;
    const [width, height] = pixels.map((side) => Math.ceil(side * (1 + 2 * MARGIN)));
    const pixel = unit / ratio;
    Object.assign(this.sheet, { width, height });
    const context = contextOf(this.sheet);
    this.ground = themeColor("sunken");
    const dot = dotOf(dotSize(1 / unit, 1.25) * ratio, themeColor("ink"));
    const half = dot.width / 2;
    for (const { points, count, stride, left, low } of source.runs(view)) {
      const [fromX, fromY] = [width / 2 + left / pixel - half, height / 2 - low / pixel - half];
      for (let p = 0; p < count * stride; p += stride) {
        const [px, py] = [fromX + points[p] / pixel, fromY - points[p + 1] / pixel];
        if (px > -dot.width && py > -dot.width && px < width && py < height) context.drawImage(dot, px, py);
      }
    }
    this.held = { x, y, unit, pixels: [...pixels], version: source.version };
  }

  /** Shades what lies outside of the region, and draws its edge. */
  edge(context, view) {
    const pixel = view.unit / view.ratio;
    const [width, height] = view.pixels;
    const within = (v, side) => Math.min(side + 4, Math.max(-4, v));
    const [left, low, right, top] = this.box.map((v, i) => {
      const at = distance({ i: v, f: 0 }, [view.x, view.y][i % 2]) / pixel;
      return i % 2 === 0 ? within(width / 2 + at, width) : within(height / 2 - at, height);
    });
    context.fillStyle = themeColor("outside");
    context.beginPath();
    context.rect(0, 0, width, height);
    context.rect(left, top, right - left, low - top);
    context.fill("evenodd");
    context.strokeStyle = themeColor("accent");
    context.lineWidth = 1.5 * view.ratio;
    context.setLineDash([6 * view.ratio, 4 * view.ratio]);
    context.strokeRect(left, top, right - left, low - top);
    context.setLineDash([]);
  }
}
