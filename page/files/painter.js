// Points on a plain canvas. Dots are set straight into pixels: several times as fast as drawing thousands of small shapes.

import { contextOf } from "./dom.js";
import { ARROW, SHAPES, isMarked, slotsOf } from "./marks.js";
import { cssOf } from "./theme.js";

const TRIANGLE = [[0.95, 0], [-0.5, 0.83], [-0.5, -0.83]];
const SQUARE = [[0.62, 0.62], [-0.62, 0.62], [-0.62, -0.62], [0.62, -0.62]];
const DIAMOND = [[0.92, 0], [0, 0.92], [-0.92, 0], [0, -0.92]];
/** The size of the hole in an open shape. */
const HOLE = 0.5;

/** The outline of each shape around 0 with radius 1, direction to the right. */
const PATHS = [
  (c) => c.arc(0, 0, 0.72, 0, 2 * Math.PI),
  (c) => polygon(c, TRIANGLE),
  (c) => polygon(c, SQUARE),
  (c) => polygon(c, DIAMOND),
  (c) => {
    c.rect(-0.82, -0.25, 1.64, 0.5);
    c.rect(-0.25, -0.82, 0.5, 1.64);
  },
  (c) => {
    c.arc(0, 0, 0.78, 0, 2 * Math.PI);
    c.moveTo(0.46, 0);
    c.arc(0, 0, 0.46, 0, 2 * Math.PI, true);
  },
  (c) => open(c, TRIANGLE),
  (c) => open(c, SQUARE),
  (c) => open(c, DIAMOND),
  (c) => c.rect(-0.9, -0.24, 1.8, 0.48),
  (c) => polygon(c, [[0.95, 0], [0.1, 0.46], [0.1, 0.1], [-0.95, 0.1], [-0.95, -0.1], [0.1, -0.1], [0.1, -0.46]]),
];

function polygon(c, corners) {
  corners.forEach(([x, y], i) => (i === 0 ? c.moveTo(x, y) : c.lineTo(x, y)));
  c.closePath();
}

/** A polygon with a hole of its shape. */
function open(c, corners) {
  polygon(c, corners);
  polygon(c, corners.map(([x, y]) => [x * HOLE, y * HOLE]).reverse());
}

/** The places within a pixel that are kept apart, along each axis. */
const STEPS = 4;
/** Samples a pixel's side for how much of it a dot covers. */
const SAMPLES = 5;

/** A color, 0 to 1 each, as the bytes of a pixel in memory order. */
function packed([r, g, b]) {
  const byte = (v) => Math.round(v * 255);
  return ((255 << 24) | (byte(b) << 16) | (byte(g) << 8) | byte(r)) >>> 0;
}

/** How a dot of a diameter covers the pixels around it, for each place within a pixel. */
function masksOf(size) {
  const radius = size / 2;
  const reach = Math.ceil(radius) + 1;
  return Array.from({ length: STEPS * STEPS }, (_, step) => {
    const center = [((step % STEPS) + 0.5) / STEPS, (Math.floor(step / STEPS) + 0.5) / STEPS];
    const mask = [];
    for (let y = -reach; y <= reach; y += 1) {
      for (let x = -reach; x <= reach; x += 1) {
        const cover = covered(x - center[0], y - center[1], radius);
        if (cover > 0) mask.push(x, y, cover);
      }
    }
    return Int32Array.from(mask);
  });
}

/** How much of a pixel lies in a circle around 0, 0 to 256. */
function covered(left, top, radius) {
  let inside = 0;
  for (let j = 0; j < SAMPLES; j += 1) {
    for (let i = 0; i < SAMPLES; i += 1) {
      if (Math.hypot(left + (i + 0.5) / SAMPLES, top + (j + 0.5) / SAMPLES) < radius) inside += 1;
    }
  }
  return Math.round((256 * inside) / SAMPLES ** 2);
}

/**
 * Sets dots into `pixels` of a picture `width` × `height`: the points of `data` from `first` on, each
 * `stride` numbers, at left + x·zoom, top − y·zoom. With `tones` the color is the one of the number in a record's `slot`.
 */
function setDots({ pixels, width, height }, { data, stride }, { first, count, left, top, zoom, masks, color: plain, tones, slot }) {
  for (let k = first; k < first + count; k += 1) {
    const color = tones ? tones[data[k * stride + slot]] ?? plain : plain;
    const [red, green, blue] = [color & 255, (color >> 8) & 255, (color >> 16) & 255];
    const x = left + data[k * stride] * zoom;
    const y = top - data[k * stride + 1] * zoom;
    const [column, row] = [Math.floor(x), Math.floor(y)];
    const mask = masks[((y - row) * STEPS | 0) * STEPS + ((x - column) * STEPS | 0)];
    for (let m = 0; m < mask.length; m += 3) {
      const [i, j] = [column + mask[m], row + mask[m + 1]];
      if (i < 0 || j < 0 || i >= width || j >= height) continue;
      const at = j * width + i;
      const cover = mask[m + 2];
      if (cover === 256) pixels[at] = color;
      else {
        const under = pixels[at];
        const [r, g, b] = [under & 255, (under >> 8) & 255, (under >> 16) & 255];
        pixels[at] = (255 << 24) | ((b + (((blue - b) * cover) >> 8)) << 16)
          | ((g + (((green - g) * cover) >> 8)) << 8) | (r + (((red - r) * cover) >> 8));
      }
    }
  }
}

export class Painter {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.context = contextOf(canvas, { alpha: false });
    this.canvas = canvas;
    /** Points painted at once between looks at the clock. */
    this.slice = 4000;
    this.budget = 250_000;
    this.most = 8192;
    this.masks = new Map();
  }

  sheet(width, height) {
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width, height });
    const context = contextOf(canvas, { alpha: false });
    const image = context.createImageData(width, height);
    return { width, height, canvas, context, image, pixels: new Uint32Array(image.data.buffer) };
  }

  drop(sheet) {
    // Browsers return the memory at once if nothing is left of it.
    Object.assign(sheet.canvas, { width: 0, height: 0 });
  }

  clear(sheet, ground, layers) {
    sheet.isDots = layers.every((layer) => !isMarked(layer) && !layer.scale);
    sheet.isTouched = sheet.isDots;
    if (sheet.isDots) sheet.pixels.fill(packed(ground));
    else {
      sheet.context.setTransform(1, 0, 0, 1, 0, 0);
      sheet.context.fillStyle = cssOf(ground);
      sheet.context.fillRect(0, 0, sheet.width, sheet.height);
    }
  }

  masksFor(size) {
    const key = size.toFixed(1);
    if (!this.masks.has(key)) {
      if (this.masks.size > 64) this.masks.clear();
      this.masks.set(key, masksOf(Number(key)));
    }
    return this.masks.get(key);
  }

  paint(sheet, chunk, { layer, first, count, corner, zoom, size, color, tones }) {
    const [left, top] = [sheet.width / 2 + corner[0], sheet.height / 2 - corner[1]];
    if (sheet.isDots) {
      sheet.isTouched = true;
      const slot = slotsOf(layer, chunk.columns).variant;
      setDots(sheet, chunk, {
        first, count, left, top, zoom, masks: this.masksFor(size), color: packed(color), tones: tones?.map(packed), slot,
      });
      return;
    }
    const { context } = sheet;
    const { data, stride } = chunk;
    const slots = slotsOf(layer, chunk.columns);
    context.fillStyle = cssOf(color);
    for (let k = first; k < first + count; k += 1) {
      const [x, y] = [left + data[k * stride] * zoom, top - data[k * stride + 1] * zoom];
      if (tones) context.fillStyle = cssOf(tones[data[k * stride + slots.variant]] ?? color);
      this.mark(context, layer, [x, y], size, slots, data.subarray(k * stride, (k + 1) * stride));
    }
    context.setTransform(1, 0, 0, 1, 0, 0);
  }

  /** Ends the painting of a frame. */
  flush(sheet) {
    if (sheet.isTouched) sheet.context.putImageData(sheet.image, 0, 0);
    sheet.isTouched = false;
  }

  mark(context, layer, [x, y], size, slots, record) {
    const radius = (size / 2) * (slots.scale < 0 ? 1 : record[slots.scale]);
    const angle = slots.angle < 0 ? 0 : record[slots.angle];
    const [cos, sin] = [Math.cos(angle) * radius, Math.sin(angle) * radius];
    const shape = layer.variant ? record[slots.variant] % SHAPES.length : layer.angle ? ARROW : 0;
    // A dot is a full circle, the circle among shapes as large as its fellows.
    const grow = isMarked(layer) ? 1 : 1 / 0.72;
    context.setTransform(cos * grow, -sin * grow, sin * grow, cos * grow, x, y);
    context.beginPath();
    PATHS[shape](context);
    context.fill();
  }

  begin(ground) {
    const { context, canvas } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = cssOf(ground);
    context.fillRect(0, 0, canvas.width, canvas.height);
  }

  show(sheet, { x, y, scale, rect }) {
    const { context, canvas } = this;
    context.save();
    if (rect) {
      const [left, bottom, width, height] = rect;
      context.beginPath();
      context.rect(left, canvas.height - bottom - height, width, height);
      context.clip();
    }
    context.imageSmoothingEnabled = scale !== 1;
    const left = Math.round(canvas.width / 2 + x - (sheet.width / 2) * scale);
    const top = Math.round(canvas.height / 2 - y - (sheet.height / 2) * scale);
    context.drawImage(sheet.canvas, left, top, Math.round(sheet.width * scale), Math.round(sheet.height * scale));
    context.restore();
  }

  finish() {
    this.context.getImageData(0, 0, 1, 1);
  }
}
