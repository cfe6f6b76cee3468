// The walk where there is no WebGL2: a plain map of what stands around, seen from above, with north up.

import { INSTANCE_FLOATS } from "./ground.js";
import { contextOf } from "../dom.js";

/** The colors of kinds; grass would hide the rest. */
const COLORS = ["#2f6b45", "#6f9a3c", "#8d8a84", "#5d7f35", "#a3ab57", "#d9b93c"];
/** Units from the middle to the nearer edge. */
const REACH = 60;

/** A map on a canvas, with the members of a scene. */
export function mapOn(canvas) {
  const context = contextOf(canvas);
  return {
    isSlow: true,
    isMap: true,
    mode: "day",
    buffer: () => null,
    free: () => {},
    resize: (ratio) => Object.assign(canvas, { width: canvas.clientWidth * ratio, height: canvas.clientHeight * ratio }),
    draw(look) {
      const { width, height } = canvas;
      const zoom = Math.min(width, height) / 2 / REACH;
      context.fillStyle = this.mode === "day" ? "#dfe6cf" : "#1c2420";
      context.fillRect(0, 0, width, height);
      let drawn = 0;
      for (const { leaf, clip, floats, runs } of look.things) {
        if (clip) continue;
        for (const { kind, first, ranks } of runs) {
          if (!COLORS[kind]) continue;
          context.fillStyle = COLORS[kind];
          for (let i = first; i < first + ranks.length; i += 1) {
            const at = i * INSTANCE_FLOATS;
            const x = width / 2 + (leaf.from[0] + floats[at]) * zoom;
            const y = height / 2 - (leaf.from[1] + floats[at + 1]) * zoom;
            const radius = Math.max(1, floats[at + 3] * 0.2 * zoom);
            if (x < -radius || y < -radius || x > width + radius || y > height + radius) continue;
            context.beginPath();
            context.arc(x, y, radius, 0, 7);
            context.fill();
            drawn += 1;
          }
        }
      }
      this.drawWalker(look, width / 2, height / 2);
      return drawn;
    },
    drawWalker({ camera: { ahead } }, x, y) {
      context.strokeStyle = context.fillStyle = "#c2410c";
      context.lineWidth = 3;
      context.beginPath();
      context.arc(x, y, 6, 0, 7);
      context.fill();
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + 22 * ahead[0], y - 22 * ahead[1]);
      context.stroke();
    },
  };
}
