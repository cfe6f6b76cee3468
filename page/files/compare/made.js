// The points of a window by each method but Strew.

import { UNIT, mix, stirred, streamOf } from "../hash.js";
import { boxOf } from "./methods.js";

/** Tries around a point before it is given up: the number of the paper. */
const TRIES = 30;
/** No two points are nearer than this, in mean spacings: chosen so that the density comes out as 1. */
export const LEAST = 0.786;

/**
 * Poisson disk sampling as R. Bridson described it (SIGGRAPH 2007 sketches): begin with one point; try up to 30 places around
 * a point that is still active, between r and 2 r away; keep those that have no point within r. Returns points x, y in turns
 * in a square of `side`; no two are nearer than `least`.
 */
export function bridson(seed, side, least = LEAST) {
  const random = streamOf(seed);
  const square = least * least;
  // A cell of this size holds one point at most.
  const cell = least / Math.SQRT2;
  const across = Math.ceil(side / cell);
  const grid = new Int32Array(across * across).fill(-1);
  const points = new Float64Array(2 * across * across);
  const active = [];
  let count = 0;
  const cellOf = (v) => Math.min(across - 1, Math.floor(v / cell));
  const add = (x, y) => {
    points[2 * count] = x;
    points[2 * count + 1] = y;
    grid[cellOf(y) * across + cellOf(x)] = count;
    active.push(count);
    count += 1;
  };
  const isFree = (x, y) => {
    const column = cellOf(x);
    const row = cellOf(y);
    const [left, right] = [Math.max(0, column - 2), Math.min(across - 1, column + 2)];
    const top = Math.min(across - 1, row + 2);
    for (let j = Math.max(0, row - 2); j <= top; j += 1) {
      for (let i = left; i <= right; i += 1) {
        const other = grid[j * across + i];
        if (other < 0) continue;
        const dx = points[2 * other] - x;
        const dy = points[2 * other + 1] - y;
        if (dx * dx + dy * dy < square) return false;
      }
    }
    return true;
  };
  const grow = (from) => {
    for (let k = 0; k < TRIES; k += 1) {
      // Uniform over the ring's area.
      const away = least * Math.sqrt(1 + 3 * random());
      const turn = 2 * Math.PI * random();
      const x = points[2 * from] + away * Math.cos(turn);
      const y = points[2 * from + 1] + away * Math.sin(turn);
      if (x < 0 || y < 0 || x >= side || y >= side || !isFree(x, y)) continue;
      add(x, y);
      return true;
    }
    return false;
  };
  add(random() * side, random() * side);
  while (active.length > 0) {
    const k = Math.floor(random() * active.length);
    if (grow(active[k])) continue;
    active[k] = active[active.length - 1];
    active.pop();
  }
  return points.slice(0, 2 * count);
}

/** The chance of no point in a cell. */
const EMPTY = Math.exp(-1);

/**
 * A Poisson process of density 1 in a window, x and y in turns from its lower corner. The number of points in a cell has the
 * Poisson distribution of mean 1 (uniform numbers are multiplied until they fall below 1/e), and each lies anywhere in it.
 */
export function white(seed, { x, y, width, height }) {
  const first = mix(seed);
  const [columns, rows] = [Math.ceil(x.f + width), Math.ceil(y.f + height)];
  const found = [];
  for (let row = 0; row < rows; row += 1) {
    const line = stirred(first, y.i + row);
    for (let column = 0; column < columns; column += 1) {
      let state = mix(stirred(line, x.i + column) + 1);
      for (let product = state * UNIT; product > EMPTY; product *= state * UNIT) {
        const across = mix(state ^ 0x9e3779b9);
        state = mix(across ^ 0x85ebca6b);
        const [dx, dy] = [column - x.f + across * UNIT, row - y.f + state * UNIT];
        if (dx >= 0 && dy >= 0 && dx < width && dy < height) found.push(dx, dy);
        state = mix(state ^ 0xc2b2ae35);
      }
    }
  }
  return Float64Array.from(found);
}

/** Of points in a box, those in a window; `isWhole` says whether the box holds all of the window. */
function cut(/** @type {Float64Array} */ points, /** @type {number[]} */ [left, low, right, top], /** @type {any} */ { x, y, width, height }) {
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
