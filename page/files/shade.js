// The field of a layer, shaded under the points: where it is dense, the ground is darker. Beyond the points, where density
// is drawn as gray, it is in the color of the layer.

import { ask } from "./api.js";
import { byId, contextOf } from "./dom.js";
import { chunksOf, cornerFrom } from "./grid.js";
import { GRAY } from "./sheets.js";
import { themeColor } from "./theme.js";
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

  draw() {
    if (!this.field || this.isWaiting || !this.plane.span) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.paint();
    });
  }

  paint() {
    if (!this.field) return;
    const { view } = this.plane;
    const [width, height] = view.pixels;
    sized(this.canvas, view.pixels);
    const context = contextOf(this.canvas);
    context.clearRect(0, 0, width, height);
    const size = 2 ** Math.round(Math.log2(SIDE * view.unit));
    const pixel = view.unit / view.ratio;
    const side = size / pixel;
    const wanted = chunksOf(view, size).map(({ cx, cy }) => ({
      left: width / 2 + cornerFrom(cx, size, view.x) / pixel,
      top: height / 2 - cornerFrom(cy, size, view.y) / pixel - side,
      tile: this.tile(size, cx, cy),
    }));
    const there = wanted.filter(({ tile }) => tile.levels);
    // All tiles are as coarse as the one that needs it most: no edges between them.
    const level = Math.max(0, ...there.map(({ tile }) => tile.levels.length - 1));
    for (const [color, strength] of this.inks()) {
      context.globalAlpha = strength;
      if (level === 0) for (const { left, top, tile } of there) context.drawImage(tinted(tile, 0, color), left, top, side, side);
      else this.paintCoarse(context, there, { level, color, side });
    }
    this.canvas.dataset.missing = String(wanted.filter(({ tile }) => !tile.levels && !tile.isGone).length);
  }

  /** What the field is drawn in: the accent under points, the color of its layer beyond them. */
  inks() {
    const { gray, look } = this.plane;
    const color = (look?.colors[this.color] ?? [0, 0, 0]).map((v) => Math.round(v * 255)).join(" ");
    return /** @type {[string, number][]} */ ([[this.accent, this.isUnder ? STRENGTH * (1 - gray) : 0], [color, GRAY * gray]])
      .filter(([, strength]) => strength > 0);
  }

  /** Draws tiles with few pixels each, smoothly over their edges. */
  paintCoarse(context, tiles, { level, color, side }) {
    const [left, top] = ["left", "top"].map((edge) => Math.min(...tiles.map((one) => one[edge])));
    const pixels = pictureOf(tiles[0].tile, level).side;
    const places = tiles.map((one) => [one.left - left, one.top - top].map((v) => Math.round(v / side) * pixels));
    const [width, height] = [0, 1].map((axis) => pixels + Math.max(...places.map((place) => place[axis])));
    Object.assign(this.mosaic, { width, height });
    tiles.forEach((one, i) => contextOf(this.mosaic).drawImage(tinted(one.tile, level, color), places[i][0], places[i][1]));
    context.drawImage(this.mosaic, left, top, (width / pixels) * side, (height / pixels) * side);
  }

  tile(size, cx, cy) {
    const key = `${size}/${cx}/${cy}`;
    let tile = this.tiles.get(key);
    if (tile) return tile;
    if (this.tiles.size >= MOST) this.tiles.delete(this.tiles.keys().next().value);
    tile = { tinted: new Map() };
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
 * dense points are there.
 */
function levelsOf(picture) {
  const side = picture.width;
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: side, height: side });
  const context = contextOf(canvas);
  context.drawImage(picture, 0, 0);
  const { data } = context.getImageData(0, 0, side, side);
  let last = { side, shares: Float32Array.from({ length: side * side }, (_, i) => data[4 * i]) };
  const levels = [last];
  while (last.side > 1 && isStatic(last)) levels.push(last = halved(last));
  return levels;
}

/** Whether the pixels of a picture say nothing of their neighbors. */
function isStatic({ side, shares }) {
  const mean = shares.reduce((sum, v) => sum + v, 0) / shares.length;
  const variance = shares.reduce((sum, v) => sum + (v - mean) ** 2, 0) / shares.length;
  const between = shares.reduce((sum, v, i) => sum + (i % side === 0 ? 0 : (v - shares[i - 1]) ** 2), 0) / (side * (side - 1));
  return variance > PLAIN && between > STATIC * 2 * variance;
}

/** A picture with half as many pixels along each side. */
function halved({ side, shares }) {
  const half = side / 2;
  const at = (i) => 2 * Math.floor(i / half) * side + 2 * (i % half);
  const mean = (k) => (shares[k] + shares[k + 1] + shares[k + side] + shares[k + side + 1]) / 4;
  return { side: half, shares: Float32Array.from({ length: half * half }, (_, i) => mean(at(i))) };
}

/** The picture of a tile, halved so often. */
function pictureOf({ levels }, level) {
  while (levels.length <= level) levels.push(halved(levels.at(-1)));
  return levels[level];
}

/** The picture of a tile in a color: clear where it is black. */
function tinted(tile, level, color) {
  const key = `${level} ${color}`;
  if (tile.tinted.has(key)) return tile.tinted.get(key);
  const { side, shares } = pictureOf(tile, level);
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: side, height: side });
  const image = new ImageData(side, side);
  const rgb = (color.match(/[\d.]+/g) ?? []).map(Number);
  for (let i = 0; i < shares.length; i += 1) {
    for (let c = 0; c < 3; c += 1) image.data[4 * i + c] = rgb[c];
    image.data[4 * i + 3] = shares[i];
  }
  contextOf(canvas).putImageData(image, 0, 0);
  tile.tinted.set(key, canvas);
  return canvas;
}
