// The work of the worker: the points of a window by each method.

import { bridson } from "./bridson.js";
import { white } from "./white.js";
import { boxOf } from "./methods.js";

/**
 * Of points in a box, those in a window; `isWhole` says whether the box holds all of the window.
 * @param {Float64Array} points
 * @param {number[]} box
 * @param {any} window
 */
function cut(points, [left, low, right, top], { x, y, width, height }) {
  const [fromX, fromY] = [x.i + x.f, y.i + y.f];
  const found = [];
  for (let p = 0; p < points.length; p += 2) {
    const [dx, dy] = [points[p] + left - fromX, points[p + 1] + low - fromY];
    if (dx >= 0 && dy >= 0 && dx < width && dy < height) found.push(dx, dy);
  }
  const isWhole = fromX >= left && fromY >= low && fromX + width <= right && fromY + height <= top;
  return { points: Float64Array.from(found), isWhole };
}

/** The set over the region of Poisson disk, which is built before any window of it, and what each point took. */
let disks = { seed: NaN, points: new Float64Array(0), nanoseconds: 0 };

/** The points of a window by a method; of one with a region also how many that has, and the time of each. */
export function made(id, seed, window) {
  const box = boxOf(id);
  if (!box) return { points: white(seed, window), isWhole: true };
  if (disks.seed !== seed) {
    const began = performance.now();
    const points = bridson(seed, box[2] - box[0]);
    disks = { seed, points, nanoseconds: ((performance.now() - began) * 1e6) / (points.length / 2) };
  }
  const { points, nanoseconds } = disks;
  return { ...cut(points, box, window), total: points.length / 2, nanoseconds };
}
