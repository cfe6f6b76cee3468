// A threshold mask, repeated, and a ramp that it dithers.

import { ask } from "../api.js";
import { contextOf } from "../dom.js";
import { distance } from "../place.js";
import { joined } from "../query.js";

/** The ramp, in pixels. */
const RAMP = { width: 320, height: 110 };

/** The parameters that say which mask. */
export function pairsOf({ profile, map, size, seed, bits }) {
  const pairs = [["size", String(size)], ["seed", seed], ["profile", profile], ["map", map]];
  return bits === "8" ? pairs : [...pairs, ["bits", bits]];
}

export class Mask {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.side = 1;
    /** @type {HTMLCanvasElement | null} */
    this.tile = null;
    /** @type {Uint8ClampedArray} */
    this.thresholds = new Uint8ClampedArray(0);
  }

  /** Whether there is something to show. */
  get isThere() {
    return this.tile !== null;
  }

  clear() {
    this.tile = null;
  }

  /** The choice as the server resolves it: `{ words, … }`, for `take`. */
  async load(state) {
    const { size } = state;
    const answer = await ask(`/v1/mask.png?${joined(pairsOf({ ...state, bits: "8" }))}`);
    const bitmap = await createImageBitmap(await answer.blob());
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: size, height: size });
    const context = contextOf(canvas, { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    const words = `${size} × ${size} pixels with ${Math.min(size ** 2, 2 ** Number(state.bits)).toLocaleString("en")} thresholds. A pixel of a picture turns white `
      + "where its gray is above the threshold.";
    return { side: size, tile: canvas, thresholds: context.getImageData(0, 0, size, size).data, words };
  }

  take({ side, tile, thresholds }) {
    this.side = side;
    this.tile = tile;
    this.thresholds = thresholds;
  }

  renew() {}

  draw(view) {
    const { canvas, side, tile } = this;
    const [width, height] = view.pixels;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = contextOf(canvas);
    if (!tile) return context.clearRect(0, 0, width, height);
    const scale = view.ratio / view.unit;
    const [x, y] = [view.x, view.y].map((at) => distance({ i: 0, f: 0 }, at) % side);
    const pattern = /** @type {CanvasPattern} */ (context.createPattern(tile, "repeat"));
    pattern.setTransform(new DOMMatrix([scale, 0, 0, scale, width / 2 + x * scale, height / 2 - y * scale]));
    context.imageSmoothingEnabled = false;
    context.fillStyle = pattern;
    context.fillRect(0, 0, width, height);
  }

  /** Draws a ramp in black and white; returns what it is. */
  picture(canvas) {
    const { side, thresholds } = this;
    const { width, height } = RAMP;
    Object.assign(canvas, RAMP);
    const context = contextOf(canvas);
    const pixels = context.createImageData(width, height);
    for (let y = 0; y < height; y += 1) {
      for (let x = 0; x < width; x += 1) {
        const gray = (256 * x) / (width - 1);
        const white = gray > thresholds[4 * ((y % side) * side + (x % side))] ? 255 : 0;
        pixels.data.set([white, white, white, 255], 4 * (y * width + x));
      }
    }
    context.putImageData(pixels, 0, 0);
    return "A ramp from black to white, dithered: every pixel is black or white.";
  }
}
