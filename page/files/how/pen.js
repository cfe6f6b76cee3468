// Drawing for the figures of the essay: shapes in CSS pixels, panels with coordinates of their own, colors by quantity.

import { isDark, themeColor } from "../theme.js";

const NAMES = ["ink", "soft", "line", "edge", "ground", "clash", "gate", "index", "block", "vector"];

/** @typedef {CanvasRenderingContext2D} Context */

/** @type {Record<string, any> | null} */
let known = null;

/** The colors of the theme and of the quantities, by name, the `family` of the type and whether it `isDark`; kept until `forget`. */
export function palette() {
  known ??= {
    ...Object.fromEntries(NAMES.map((name) => [name, themeColor(name)])),
    family: getComputedStyle(document.body).fontFamily,
    isDark: isDark(),
  };
  return known;
}

/** Has colors looked up again. */
export function forget() {
  known = null;
}

/** A share of a way that begins and ends gently. */
export const eased = (/** @type {number} */ share) => share * share * (3 - 2 * share);

/** The radius of a dot of the grid where a step is so many pixels long. */
export function dotOf(scale) {
  return Math.max(1.7, scale * 0.4);
}

/** A circle, filled or, with a thickness, in outline. */
export function disk(/** @type {Context} */ context, /** @type {number[]} */ [x, y], /** @type {number} */ radius, /** @type {string} */ color, thickness = 0) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  if (thickness > 0) {
    context.strokeStyle = color;
    context.lineWidth = thickness;
    context.stroke();
  } else {
    context.fillStyle = color;
    context.fill();
  }
}

/** Many circles of one color, which may be faint. */
export function disks(context, places, radius, color, alpha = 1) {
  context.globalAlpha = alpha;
  context.fillStyle = color;
  context.beginPath();
  for (const [x, y] of places) {
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
  }
  context.fill();
  context.globalAlpha = 1;
}

export function line(/** @type {Context} */ context, /** @type {number[]} */ [x, y], /** @type {number[]} */ [u, v], /** @type {string} */ color, thickness = 1) {
  context.strokeStyle = color;
  context.lineWidth = thickness;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(u, v);
  context.stroke();
}

/** Many lines of one color, each `[from, to]`. */
export function lines(/** @type {Context} */ context, /** @type {number[][][]} */ pairs, /** @type {string} */ color, thickness = 1) {
  context.strokeStyle = color;
  context.lineWidth = thickness;
  context.beginPath();
  for (const [[x, y], [u, v]] of pairs) {
    context.moveTo(x, y);
    context.lineTo(u, v);
  }
  context.stroke();
}

/** A line with a head at its end; what is too short has none. */
export function arrow(/** @type {Context} */ context, /** @type {number[]} */ from, /** @type {number[]} */ to, /** @type {string} */ color, thickness = 1.5) {
  line(context, from, to, color, thickness);
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  if (length < 3) return;
  const [u, v] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  const head = Math.min(length * 0.6, 3 + 2 * thickness);
  context.fillStyle = color;
  context.beginPath();
  context.moveTo(to[0], to[1]);
  context.lineTo(to[0] - head * (u + 0.5 * v), to[1] - head * (v - 0.5 * u));
  context.lineTo(to[0] - head * (u - 0.5 * v), to[1] - head * (v + 0.5 * u));
  context.fill();
}

/** Words on a canvas around a place. */
export function words(/** @type {Context} */ context, /** @type {string} */ text, /** @type {number[]} */ [x, y], /** @type {string} */ color, size = 12) {
  context.font = `${size}px ${palette().family}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = color;
  context.fillText(text, x, y);
}

/** A dial: a gate of a number of turns from the right side on, and a hand at a turn; turns go against the clock. */
export function dial(/** @type {Context} */ context, /** @type {number[]} */ [x, y], /** @type {number} */ radius, /** @type {number} */ gate, /** @type {number} */ turn) {
  const colors = palette();
  context.fillStyle = colors.gate;
  context.globalAlpha = 0.3;
  context.beginPath();
  context.moveTo(x, y);
  context.arc(x, y, radius, 0, -2 * Math.PI * gate, true);
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = colors.gate;
  context.lineWidth = 3;
  context.beginPath();
  context.arc(x, y, radius, 0, -2 * Math.PI * gate, true);
  context.stroke();
  disk(context, [x, y], radius, colors.edge, 1);
  const end = [x + radius * 0.94 * Math.cos(2 * Math.PI * turn), y - radius * 0.94 * Math.sin(2 * Math.PI * turn)];
  arrow(context, [x, y], end, colors.index, Math.max(2, radius / 22));
  disk(context, [x, y], Math.max(2, radius / 18), colors.index);
}

/** A part of a canvas, a box in pixels with a range of coordinates of its own, y upward. */
export class Panel {
  constructor(/** @type {number[]} */ [left, top, width, height], /** @type {number[]} */ [x0, y0], /** @type {number[]} */ [x1, y1]) {
    this.left = left;
    this.top = top;
    this.width = width;
    this.height = height;
    this.x0 = x0;
    this.y0 = y0;
    this.x1 = x1;
    this.y1 = y1;
    this.scale = width / (x1 - x0);
  }

  /** The pixels of a place. */
  to(/** @type {number[]} */ [x, y]) {
    return [this.left + (x - this.x0) * this.scale, this.top + this.height - ((y - this.y0) * this.height) / (this.y1 - this.y0)];
  }

  /** The place of a pixel. */
  from(/** @type {number[]} */ [x, y]) {
    return [this.x0 + (x - this.left) / this.scale, this.y0 + ((this.top + this.height - y) * (this.y1 - this.y0)) / this.height];
  }

  /** @param {number[]} pixel */
  holds([x, y]) {
    return x >= this.left && x <= this.left + this.width && y >= this.top && y <= this.top + this.height;
  }

  /** Draws inside of the panel only. */
  clipped(context, draw) {
    context.save();
    context.beginPath();
    context.rect(this.left, this.top, this.width, this.height);
    context.clip();
    draw();
    context.restore();
  }

  /** Fills a box with a color, which may be faint. */
  fill(/** @type {Context} */ context, /** @type {number[]} */ [x, y], /** @type {number[]} */ [width, height], /** @type {string} */ color, alpha = 1) {
    const [left, bottom] = this.to([x, y]);
    const [right, top] = this.to([x + width, y + height]);
    context.globalAlpha = alpha;
    context.fillStyle = color;
    context.fillRect(left, top, right - left, bottom - top);
    context.globalAlpha = 1;
  }

  outline(/** @type {Context} */ context, /** @type {number[]} */ [x, y], /** @type {number[]} */ [width, height], /** @type {string} */ color, thickness = 1) {
    const [left, bottom] = this.to([x, y]);
    const [right, top] = this.to([x + width, y + height]);
    context.strokeStyle = color;
    context.lineWidth = thickness;
    context.strokeRect(left, top, right - left, bottom - top);
  }

  frame(context, color, thickness = 1) {
    this.outline(context, [this.x0, this.y0], [this.x1 - this.x0, this.y1 - this.y0], color, thickness);
  }
}

/** Two square panels side by side, each with the range of its coordinates; `share` is theirs of the width. */
export function pair(/** @type {number} */ width, /** @type {number} */ height, /** @type {number[][]} */ first, /** @type {number[][]} */ second, share = 0.485) {
  const side = Math.min(height - 2, width * share);
  const top = (height - side) / 2;
  return [new Panel([1, top, side, side], first[0], first[1]), new Panel([width - side - 1, top, side, side], second[0], second[1])];
}
