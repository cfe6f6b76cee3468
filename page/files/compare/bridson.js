// Poisson disk sampling as R. Bridson described it (SIGGRAPH 2007 sketches): begin with one point; try up to 30
// places around a point that is still active, between r and 2 r away; keep those that have no point within r.

import { streamOf } from "../hash.js";

/** Tries around a point before it is given up: the number of the paper. */
const TRIES = 30;
/** No two points are nearer than this, in mean spacings: chosen so that the density comes out as 1. */
export const LEAST = 0.786;

/** Points x, y in turns in a square of `side`; no two are nearer than `least`. */
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
