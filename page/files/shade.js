// The field of a layer, shaded under the points: where it is dense, the ground is darker. Beyond the points, where density
// is drawn as gray, it is in the color of the layer.

import { ask } from "./api.js";
import { byId, contextOf } from "./dom.js";
import { chunksOf, cornerFrom } from "./grid.js";
import { Part } from "./part.js";
import { GRAY } from "./sheets.js";
import { themeColor } from "./theme.js";

/** The width of a tile in CSS pixels, about. */
const SIDE = 360;
/** The most tiles that are kept. */
const MOST = 200;
/** How dark the ground becomes where the field is 1. */
const STRENGTH = 0.28;

export class Shade extends Part {
  constructor(plane) {
    super();
    this.plane = plane;
    this.canvas = byId("shade");
    this.field = "";
    /** The color that it is drawn in where points are too many, or nothing. */
    this.tint = "";
    this.layers = [];
    this.tiles = new Map();
  }

  /** The layers that are shown now. */
  shown(layers) {
    this.layers = layers;
    this.choose();
    this.draw();
  }

  /** Chooses the field: the first that is to be shown, or beyond the points the first of all. */
  choose() {
    const isGray = this.plane.isGray;
    const layer = this.layers.find(({ field, shade }) => field && (shade || isGray));
    const field = layer?.field ?? "";
    const tint = isGray && layer ? (this.plane.look?.colors[layer.color] ?? [0, 0, 0]).map((v) => Math.round(v * 255)).join(" ") : "";
    if (field !== this.field) this.tiles.clear();
    if (tint !== this.tint) for (const tile of this.tiles.values()) tile.tinted = null;
    Object.assign(this, { field, tint });
    this.canvas.hidden = !field;
  }

  moved() {
    this.draw();
  }

  painted() {
    if (this.plane.isGray === Boolean(this.tint)) return;
    this.choose();
    this.draw();
  }

  themed() {
    for (const tile of this.tiles.values()) tile.tinted = null;
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
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    const context = contextOf(this.canvas);
    context.clearRect(0, 0, width, height);
    const size = 2 ** Math.round(Math.log2(SIDE * view.unit));
    const pixel = view.unit / view.ratio;
    const side = size / pixel;
    let missing = 0;
    for (const { cx, cy } of chunksOf(view, size)) {
      const tile = this.tile(size, cx, cy);
      if (!tile.picture) {
        missing += tile.isGone ? 0 : 1;
        continue;
      }
      tile.tinted ??= tinted(tile.picture, this.tint);
      const left = width / 2 + cornerFrom(cx, size, view.x) / pixel;
      const top = height / 2 - cornerFrom(cy, size, view.y) / pixel - side;
      context.drawImage(tile.tinted, left, top, side, side);
    }
    this.canvas.dataset.missing = String(missing);
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
      tile.picture = await createImageBitmap(await answer.blob());
    } catch {
      // Without it the points show well enough.
      tile.isGone = true;
    }
    this.draw();
  }
}

/** A gray picture in a color, or the accent of the theme: clear where it is black. */
function tinted(picture, tint) {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: picture.width, height: picture.height });
  const context = contextOf(canvas);
  context.drawImage(picture, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  const [red, green, blue] = ((tint || themeColor("accent")).match(/[\d.]+/g) ?? []).map(Number);
  const strength = tint ? GRAY : STRENGTH;
  const { data } = pixels;
  for (let i = 0; i < data.length; i += 4) {
    const share = data[i];
    [data[i], data[i + 1], data[i + 2], data[i + 3]] = [red, green, blue, strength * share];
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}
