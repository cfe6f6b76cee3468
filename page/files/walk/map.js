// The land from above, with north up: a small map in a corner of the walk, and the walk itself where there is no WebGL2.

import { contextOf } from "../dom.js";
import { distance, place } from "../place.js";
import { fineness, sized } from "../view.js";
import { INSTANCE_FLOATS } from "./ground.js";
import { TRAIL, landFrom } from "./land.js";

/** The colors of kinds; grass would hide the rest. */
const COLORS = ["#2f6b45", "#6f9a3c", "#8d8a84", "#5d7f35", "#a3ab57", "#d9b93c"];
/** The ground without trees, below trees, and the trail: red, green and blue. */
const GROUNDS = {
  day: [[223, 230, 207], [168, 190, 148], [201, 176, 137]],
  dusk: [[52, 58, 46], [24, 38, 32], [110, 84, 66]],
};
const WALKER = "#c2410c";
/** Units from the middle to the nearer edge: of the picture of the walk, and of the small map. */
const WIDE = 60;
const SMALL = 110;
/** Cells of the ground along a side, and the steps in which it follows the walker, in units. */
const CELLS = 90;
const FOLLOWS = 16;

class Plan {
  constructor(canvas, reach) {
    this.canvas = canvas;
    this.reach = reach;
    this.context = contextOf(canvas);
    this.ground = document.createElement("canvas");
    /** What of the ground is painted: where its corner is, and its side. */
    this.key = "";
    this.corner = [place(0), place(0)];
    this.side = 1;
  }

  /** Paints the ground around a place, unless it is there from before. */
  prepare({ x, y }, mode) {
    const [left, low] = [x, y].map(({ i }) => Math.floor(i / FOLLOWS) * FOLLOWS);
    const key = `${left} ${low} ${mode}`;
    if (key === this.key) return;
    const side = 2 * this.sideways() + 2 * FOLLOWS;
    Object.assign(this, { key, side, corner: [place(left), place(low)] });
    Object.assign(this.ground, { width: CELLS, height: CELLS });
    const context = contextOf(this.ground);
    const pixels = context.createImageData(CELLS, CELLS);
    const land = landFrom([left, low]);
    const [open, woods, trail] = GROUNDS[mode];
    for (let p = 0; p < CELLS * CELLS; p += 1) {
      const [px, py] = [p % CELLS, CELLS - 1 - Math.floor(p / CELLS)].map((v) => ((v + 0.5) / CELLS - 0.5) * side + FOLLOWS / 2);
      const share = Math.min(1, land.trees(px, py) / 0.6);
      const isTrail = Math.abs(land.trail(px, py)) < 1.2 * TRAIL;
      for (let c = 0; c < 3; c += 1) pixels.data[4 * p + c] = isTrail ? trail[c] : open[c] + (woods[c] - open[c]) * share;
      pixels.data[4 * p + 3] = 255;
    }
    context.putImageData(pixels, 0, 0);
  }

  /** Half of the longer side in units. */
  sideways() {
    const { width, height } = this.canvas;
    return (this.reach * Math.max(width, height)) / Math.max(1, Math.min(width, height));
  }

  /** Draws the ground, what stands on it and the walker; returns how many points. */
  draw({ things, at, camera, isSmall }, mode) {
    const { canvas: { width, height }, context, reach } = this;
    const zoom = Math.min(width, height) / 2 / reach;
    this.prepare(at, mode);
    const [left, low] = [at.x, at.y].map((v, i) => distance(this.corner[i], v) + FOLLOWS / 2);
    const side = this.side * zoom;
    context.drawImage(this.ground, width / 2 + left * zoom - side / 2, height / 2 - low * zoom - side / 2, side, side);
    let drawn = 0;
    for (const { leaf, clip, floats, runs } of things) {
      if (clip) continue;
      for (const { kind, first, ranks } of runs) {
        // On the small map, only trees and rocks.
        if (!COLORS[kind] || (isSmall && kind > 2)) continue;
        context.fillStyle = COLORS[kind];
        for (let i = first; i < first + ranks.length; i += 1) {
          const k = i * INSTANCE_FLOATS;
          const x = width / 2 + (leaf.from[0] + floats[k]) * zoom;
          const y = height / 2 - (leaf.from[1] + floats[k + 1]) * zoom;
          const radius = Math.max(1, floats[k + 3] * 0.2 * zoom);
          if (x < -radius || y < -radius || x > width + radius || y > height + radius) continue;
          if (isSmall) context.fillRect(x - radius / 2, y - radius / 2, radius, radius);
          else {
            context.beginPath();
            context.arc(x, y, radius, 0, 7);
            context.fill();
          }
          drawn += 1;
        }
      }
    }
    this.drawWalker(camera.ahead, width / 2, height / 2, Math.min(width, height) / (isSmall ? 26 : 90));
    return drawn;
  }

  drawWalker([east, north], x, y, size) {
    const { context } = this;
    const along = Math.hypot(east, north) || 1;
    const [dx, dy] = [(east / along) * size, (-north / along) * size];
    context.fillStyle = WALKER;
    context.strokeStyle = "#fff";
    context.lineWidth = size / 4;
    context.beginPath();
    context.moveTo(x + 1.6 * dx, y + 1.6 * dy);
    context.lineTo(x - dx - 0.9 * dy, y - dy + 0.9 * dx);
    context.lineTo(x - 0.5 * dx, y - 0.5 * dy);
    context.lineTo(x - dx + 0.9 * dy, y - dy - 0.9 * dx);
    context.closePath();
    context.stroke();
    context.fill();
  }
}

/** A map on a canvas that takes the place of the picture, with the members of a scene. */
export function mapOn(canvas) {
  const plan = new Plan(canvas, WIDE);
  return {
    isSlow: true,
    isMap: true,
    mode: "day",
    buffer: () => null,
    free: () => {},
    resize: (ratio) => Object.assign(canvas, { width: canvas.clientWidth * ratio, height: canvas.clientHeight * ratio }),
    draw(look) {
      return plan.draw(look, this.mode);
    },
  };
}

/** The small map on a canvas: `draw(look, mode)`. */
export function smallMapOn(canvas) {
  const plan = new Plan(canvas, SMALL);
  return {
    draw(look, mode) {
      const side = Math.round(canvas.clientWidth * fineness());
      if (side > 0) sized(canvas, [side, side]);
      return plan.draw({ ...look, isSmall: true }, mode);
    },
  };
}
