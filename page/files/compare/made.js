// The work of the worker: the points of a window by each method, and the time per point.

import { bridson } from "./bridson.js";
import { jittered, repeated, white } from "./cells.js";
import { halton } from "./halton.js";
import { MEASURED, TILE, methodOf } from "./methods.js";
import { tileOf } from "./tile.js";

/** The least time of a run that is timed, in milliseconds, and the number of runs. */
const LEAST_RUN = 12;
const RUNS = 3;

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

/** Points that were built over the box of a method, before any window of them. */
function built(id, build) {
  const { box = [0, 0, 0, 0] } = methodOf(id) ?? {};
  const [width, height] = [box[2] - box[0], box[3] - box[1]];
  const run = () => {
    const began = performance.now();
    const points = build(width, height);
    return { points, took: performance.now() - began };
  };
  const { points, took } = run();
  return {
    window: (window) => ({ ...cut(points, box, window), total: points.length / 2 }),
    time: () => {
      // Once more, when the engine has compiled what runs often and the page is at rest.
      const best = Math.min(took, run().took);
      return { nanoseconds: (best * 1e6) / (points.length / 2), built: best };
    },
  };
}

/** The nanoseconds per point of a method that makes any window alone: the best of some runs. */
function timed(make) {
  const window = { x: { i: 0, f: 0 }, y: { i: 0, f: 0 }, width: MEASURED, height: MEASURED };
  let best = Infinity;
  for (let run = 0; run < RUNS; run += 1) {
    const began = performance.now();
    let [took, count] = [0, 0];
    while (took < LEAST_RUN) {
      count += make(window).length / 2;
      took = performance.now() - began;
    }
    best = Math.min(best, (took * 1e6) / count);
  }
  return best;
}

/** A method that makes any window alone. */
function anywhere(make, before = 0) {
  return {
    window: (window) => ({ points: make(window), isWhole: true }),
    time: () => ({ nanoseconds: timed(make), built: before }),
  };
}

const MAKERS = {
  jitter: (seed) => anywhere((window) => jittered(seed, window)),
  white: (seed) => anywhere((window) => white(seed, window)),
  tile: (seed) => {
    const began = performance.now();
    const square = { tile: tileOf(seed, TILE), side: TILE };
    return anywhere((window) => repeated(square, window), performance.now() - began);
  },
  poisson: (seed) => built("poisson", (width) => bridson(seed, width)),
  halton: () => built("halton", (width, height) => halton(width * height, width, height)),
};

const kept = new Map();

/** A method with a seed; what has to be built first is built once. */
export function made(id, seed) {
  const held = kept.get(id);
  if (held?.seed === seed) return held.method;
  const method = MAKERS[id](seed);
  kept.set(id, { seed, method });
  return method;
}
