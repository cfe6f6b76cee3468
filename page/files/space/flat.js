// The volume where there is no WebGL2: the same dots on a plain canvas, far ones first.

import { contextOf } from "../dom.js";
import { projected } from "../walk/camera.js";
import { EDGES, RADIUS, WHOLE } from "./scene.js";

/** Steps of depth, each with a color of its own. */
const STEPS = 16;

const css = (color) => `rgb(${color.map((v) => Math.round(255 * v)).join(" ")})`;
const mixed = (a, b, share) => a.map((v, i) => v + (b[i] - v) * share);

/**
 * A canvas with the members of a scene.
 * @param {HTMLCanvasElement} canvas
 */
export function flatOn(canvas) {
  const context = contextOf(canvas);
  return {
    isFlat: true,
    /** @param {Record<string, any>} seen */
    draw({ camera, chunks, scale, middle, reach, depths, slab, box, colors }) {
      const { width, height } = canvas;
      context.fillStyle = css(colors.ground);
      context.fillRect(0, 0, width, height);
      const place = (/** @type {number[]} */ at) => {
        const seen = projected(camera, at);
        return seen && [(1 + seen.x) * width / 2, (1 - seen.y) * height / 2, seen.depth];
      };
      /** @type {number[][][]} */
      const steps = Array.from({ length: STEPS }, () => [[], []]);
      const lens = height / 2 / camera.tall;
      for (const { chunk: { data, count, stride }, corner } of chunks) {
        for (let i = 0; i < count * stride; i += stride) {
          const at = [0, 1, 2].map((axis) => corner[axis] + data[i + axis] * scale);
          const off = Math.hypot(at[0] - middle[0], at[1] - middle[1], at[2] - middle[2]);
          const edge = Math.min(1, (1 - off / reach) / (1 - WHOLE));
          const seen = edge > 0 && place(at);
          if (!seen || seen[0] < 0 || seen[1] < 0 || seen[0] > width || seen[1] > height) continue;
          const far = (seen[2] - depths[0]) / (depths[1] - depths[0]);
          const step = Math.max(0, Math.min(STEPS - 1, Math.floor(far * STEPS)));
          const isSlab = Math.abs(at[2] - middle[2]) < slab;
          steps[step][isSlab ? 1 : 0].push(seen[0], seen[1], Math.max(0.6, (RADIUS * lens * Math.sqrt(edge)) / Math.max(1, seen[2])));
        }
      }
      for (let step = STEPS - 1; step >= 0; step -= 1) {
        const far = (step + 0.5) / STEPS;
        const own = [mixed(colors.near, colors.far, far), colors.slab];
        steps[step].forEach((dots, kind) => {
          context.fillStyle = css(mixed(own[kind], colors.ground, (kind ? 0.5 : 0.88) * far));
          for (let i = 0; i < dots.length; i += 3) this.dot(dots[i], dots[i + 1], dots[i + 2]);
        });
      }
      if (box) this.drawBox(box, place, colors.line);
    },
    dot(x, y, radius) {
      if (radius < 1.2) return context.fillRect(x - radius, y - radius, 2 * radius, 2 * radius);
      context.beginPath();
      context.arc(x, y, radius, 0, 7);
      context.fill();
    },
    drawBox({ corner, side }, place, color) {
      context.strokeStyle = css(color);
      context.beginPath();
      for (let i = 0; i < EDGES.length; i += 2) {
        const [a, b] = [EDGES[i], EDGES[i + 1]].map((end) => place(end.map((v, axis) => corner[axis] + v * side)));
        if (!a || !b) continue;
        context.moveTo(a[0], a[1]);
        context.lineTo(b[0], b[1]);
      }
      context.stroke();
    },
  };
}
