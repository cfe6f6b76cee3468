// The field of a layer, shaded under the points: where it is dense, the ground is darker. Beyond the points, where density
// is drawn as gray, it is in the color of the layer.

import { ask } from "./api.js";
import { byId, contextOf, framed } from "./dom.js";
import { chunksOf, cornerFrom } from "./grid.js";
import { GRAY } from "./sheets.js";
import { cssOf, themeColor } from "./theme.js";
import { sized } from "./view.js";

/** The width of a tile in CSS pixels, about. */
const SIDE = 360;
/** The most tiles that are kept. */
const MOST = 200;
/** How much of the ground the accent covers where the field is 1. */
const STRENGTH = 0.28;
/** Neighbors in a picture differ by chance beyond this share of what they would if they were independent. */
const STATIC = 0.5;
/** Pictures whose variance is below this, in squares of their 255 steps, are plain. */
const PLAIN = 2;

export class Shade {
  constructor(plane) {
    this.plane = plane;
    this.canvas = byId("shade");
    this.field = "";
    /** Whether it is shown under points, and the number of the color that it has beyond them. */
    this.isUnder = false;
    this.color = 0;
    this.gray = 0;
    this.accent = themeColor("accent");
    this.layers = [];
    this.tiles = new Map();
    this.mosaic = document.createElement("canvas");
    this.draw = framed(() => this.paint());
  }

  /** The layers that are shown now. */
  shown(layers) {
    this.layers = layers;
    this.choose();
    this.draw();
  }

  /** Chooses the field: the first that is to be shown, or where points fade into gray the first of all. */
  choose() {
    const { gray } = this.plane;
    const layer = this.layers.find(({ field, shade }) => field && (shade || gray > 0));
    const field = layer?.field ?? "";
    if (field !== this.field) this.tiles.clear();
    Object.assign(this, { field, gray, isUnder: Boolean(layer?.shade), color: layer?.color ?? 0 });
    this.canvas.hidden = !field;
  }

  moved() {
    this.draw();
  }

  painted() {
    if (this.plane.gray === this.gray) return;
    this.choose();
    this.draw();
  }

  themed() {
    this.accent = themeColor("accent");
    this.draw();
  }

  paint() {
    if (!this.field || !this.plane.span) return;
    const { view } = this.plane;
    const [width, height] = view.pixels;
    sized(this.canvas, view.pixels);
    const context = contextOf(this.canvas);
    context.clearRect(0, 0, width, height);
    const size = 2 ** Math.round(Math.log2(SIDE * view.unit));
    const pixel = view.unit / view.ratio;
    const wanted = chunksOf(view, size).map(({ cx, cy }) => ({ cx, cy, tile: this.tile(size, cx, cy) }));
    this.canvas.dataset.missing = String(wanted.filter(({ tile }) => !tile.levels && !tile.isGone).length);
    const there = wanted.filter(({ tile }) => tile.levels);
    if (there.length === 0) return;
    // All tiles are as coarse as the one that needs it most, and beside each other on one picture: no edges between them.
    const level = Math.max(...there.map(({ tile }) => tile.levels.length - 1));
    const [left, top] = [Math.min(...there.map(({ cx }) => cx)), Math.max(...there.map(({ cy }) => cy))];
    const side = pictureOf(there[0].tile, level).width;
    const count = [Math.max(...there.map(({ cx }) => cx)) - left + 1, top - Math.min(...there.map(({ cy }) => cy)) + 1];
    Object.assign(this.mosaic, { width: side * count[0], height: side * count[1] });
    const ink = contextOf(this.mosaic);
    for (const { cx, cy, tile } of there) ink.drawImage(pictureOf(tile, level), (cx - left) * side, (top - cy) * side);
    ink.globalCompositeOperation = "source-in";
    const corner = [width / 2 + cornerFrom(left, size, view.x) / pixel, height / 2 - (cornerFrom(top, size, view.y) + size) / pixel];
    for (const [color, strength] of this.inks()) {
      ink.fillStyle = color;
      ink.fillRect(0, 0, this.mosaic.width, this.mosaic.height);
      context.globalAlpha = strength;
      context.drawImage(this.mosaic, corner[0], corner[1], (count[0] * size) / pixel, (count[1] * size) / pixel);
    }
  }

  /** What the field is drawn in: the accent under points, the color of its layer beyond them. */
  inks() {
    const { gray, look } = this.plane;
    const color = cssOf(look?.colors[this.color] ?? [0, 0, 0]);
    return /** @type {[string, number][]} */ ([[this.accent, this.isUnder ? STRENGTH * (1 - gray) : 0], [color, GRAY * gray]])
      .filter(([, strength]) => strength > 0);
  }

  tile(size, cx, cy) {
    const key = `${size}/${cx}/${cy}`;
    let tile = this.tiles.get(key);
    if (tile) return tile;
    if (this.tiles.size >= MOST) this.tiles.delete(this.tiles.keys().next().value);
    tile = {};
    this.tiles.set(key, tile);
    this.load(tile, `/v1/fields/${encodeURIComponent(this.field)}/chunks/${key}`);
    return tile;
  }

  async load(tile, path) {
    try {
      const answer = await ask(path);
      tile.levels = levelsOf(await createImageBitmap(await answer.blob()));
    } catch {
      // Without it the points show well enough.
      tile.isGone = true;
    }
    this.draw();
  }
}

/**
 * A picture, halved as often as its pixels are static: samples of a field that is finer than they are. Their means are how
 * dense points are there. Each is clear where the field is 0.
 */
function levelsOf(picture) {
  const side = picture.width;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: side, height: side });
  const context = contextOf(canvas, { willReadFrequently: true });
  context.drawImage(picture, 0, 0);
  const image = context.getImageData(0, 0, side, side);
  for (let i = 0; i < image.data.length; i += 4) image.data[i + 3] = image.data[i];
  context.putImageData(image, 0, 0);
  const levels = [canvas];
  for (let last = canvas; last.width > 1 && isStatic(last); last = levels[levels.length - 1]) levels.push(halved(last));
  return levels;
}

/** Whether the pixels of a picture say nothing of their neighbors. */
function isStatic(picture) {
  const side = picture.width;
  const shares = contextOf(picture).getImageData(0, 0, side, side).data.filter((_, i) => i % 4 === 3);
  const mean = shares.reduce((sum, v) => sum + v, 0) / shares.length;
  const variance = shares.reduce((sum, v) => sum + (v - mean) ** 2, 0) / shares.length;
  const between = shares.reduce((sum, v, i) => sum + (i % side === 0 ? 0 : (v - shares[i - 1]) ** 2), 0) / (side * (side - 1));
  return variance > PLAIN && between > STATIC * 2 * variance;
}

/** A picture with half as many pixels along each side: each is the mean of four. */
function halved(picture) {
  const half = picture.width / 2;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: half, height: half });
  contextOf(canvas, { willReadFrequently: true }).drawImage(picture, 0, 0, half, half);
  return canvas;
}

/** The picture of a tile, halved so often. */
function pictureOf({ levels }, level) {
  while (levels.length <= level) levels.push(halved(levels.at(-1)));
  return levels[level];
}
