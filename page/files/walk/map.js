// The land from above, with north up: a small map in a corner of the walk.

import { contextOf } from "../dom.js";
import { distance, place } from "../place.js";
import { fineness, sized } from "../view.js";
import { INSTANCE_FLOATS } from "./ground.js";
import { TRAIL, landFrom } from "./land.js";

/** The colors of trees and rocks; what grows between them would hide the rest. */
const COLORS = ["#2f6b45", "#6f9a3c", "#8d8a84"];
/** The ground without trees, below trees, and the trail: red, green and blue. */
const GROUNDS = {
  day: [[223, 230, 207], [168, 190, 148], [201, 176, 137]],
  dusk: [[52, 58, 46], [24, 38, 32], [110, 84, 66]],
};
const WALKER = "#c2410c";
/** Units from the middle to the edge. */
const REACH = 110;
/** Cells of the ground along a side, and the steps in which it follows the walker, in units. */
const CELLS = 90;
const FOLLOWS = 16;
const SIDE = 2 * REACH + 2 * FOLLOWS;

export class Plan {
  /** A map on a canvas that is square. */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = contextOf(canvas);
    this.ground = document.createElement("canvas");
    /** What of the ground is painted, and where its corner is. */
    this.key = "";
    this.corner = [place(0), place(0)];
  }

  /** Paints the ground around a place, unless it is there from before. */
  prepare({ x, y }, mode) {
    const [left, low] = [x, y].map(({ i }) => Math.floor(i / FOLLOWS) * FOLLOWS);
    const key = `${left} ${low} ${mode}`;
    if (key === this.key) return;
    Object.assign(this, { key, corner: [place(left), place(low)] });
    Object.assign(this.ground, { width: CELLS, height: CELLS });
    const context = contextOf(this.ground);
    const pixels = context.createImageData(CELLS, CELLS);
    const land = landFrom([left, low]);
    const [open, woods, trail] = GROUNDS[mode];
    for (let p = 0; p < CELLS * CELLS; p += 1) {
      const [px, py] = [p % CELLS, CELLS - 1 - Math.floor(p / CELLS)].map((v) => ((v + 0.5) / CELLS - 0.5) * SIDE + FOLLOWS / 2);
      const share = Math.min(1, land.trees(px, py) / 0.6);
      const isTrail = Math.abs(land.trail(px, py)) < 1.2 * TRAIL;
      for (let c = 0; c < 3; c += 1) pixels.data[4 * p + c] = isTrail ? trail[c] : open[c] + (woods[c] - open[c]) * share;
      pixels.data[4 * p + 3] = 255;
    }
    context.putImageData(pixels, 0, 0);
  }

  /** Draws the ground, the trees and rocks on it, and the walker. */
  draw({ things, at, camera }, mode) {
    const size = Math.round(this.canvas.clientWidth * fineness());
    if (size > 0) sized(this.canvas, [size, size]);
    const { canvas: { width }, context } = this;
    const zoom = width / 2 / REACH;
    this.prepare(at, mode);
    const [left, low] = [at.x, at.y].map((v, i) => distance(this.corner[i], v) + FOLLOWS / 2);
    const side = SIDE * zoom;
    context.drawImage(this.ground, width / 2 + left * zoom - side / 2, width / 2 - low * zoom - side / 2, side, side);
    for (const { leaf, clip, floats, runs } of things) {
      for (const { kind, first, ranks } of clip ? [] : runs) {
        if (!COLORS[kind]) continue;
        context.fillStyle = COLORS[kind];
        for (let k = first * INSTANCE_FLOATS; k < (first + ranks.length) * INSTANCE_FLOATS; k += INSTANCE_FLOATS) {
          const dot = Math.max(1, floats[k + 3] * 0.2 * zoom);
          const [x, y] = [width / 2 + (leaf.from[0] + floats[k]) * zoom, width / 2 - (leaf.from[1] + floats[k + 1]) * zoom];
          context.fillRect(x - dot / 2, y - dot / 2, dot, dot);
        }
      }
    }
    this.drawWalker(camera.ahead, width / 2, width / 26);
  }

  drawWalker([east, north], middle, size) {
    const { context } = this;
    const along = Math.hypot(east, north) || 1;
    const [dx, dy] = [(east / along) * size, (-north / along) * size];
    context.fillStyle = WALKER;
    context.strokeStyle = "#fff";
    context.lineWidth = size / 4;
    context.beginPath();
    context.moveTo(middle + 1.6 * dx, middle + 1.6 * dy);
    context.lineTo(middle - dx - 0.9 * dy, middle - dy + 0.9 * dx);
    context.lineTo(middle - 0.5 * dx, middle - 0.5 * dy);
    context.lineTo(middle - dx + 0.9 * dy, middle - dy - 0.9 * dx);
    context.closePath();
    context.stroke();
    context.fill();
  }
}
