// A Poisson disk set in a box of space, by R. Bridson's method (SIGGRAPH 2007 sketches): begin with one point; try up to
// 30 places around a point that is still active, between r and 2 r away; keep those that have no point within r.

import { streamOf } from "../compare/hash.js";

/** Tries around a point before it is given up: the number of the paper. */
const TRIES = 30;
/** No two points are nearer than this, in mean spacings: chosen so that the density comes out as 1. */
const LEAST = 0.831;

/** Points x, y, z in turns in a box of three sides; no two are nearer than `least`. */
export function bridson(seed, [width, depth, height], least = LEAST) {
  const random = streamOf(seed);
  const square = least * least;
  // A cell of this size holds one point at most.
  const cell = least / Math.sqrt(3);
  const sides = [width, depth, height].map((side) => Math.ceil(side / cell));
  const [nx, ny, nz] = sides;
  const grid = new Int32Array(nx * ny * nz).fill(-1);
  const points = new Float64Array(3 * grid.length);
  const active = [];
  let count = 0;
  const cellOf = (v, n) => Math.min(n - 1, Math.floor(v / cell));
  const add = (x, y, z) => {
    points.set([x, y, z], 3 * count);
    grid[(cellOf(z, nz) * ny + cellOf(y, ny)) * nx + cellOf(x, nx)] = count;
    active.push(count);
    count += 1;
  };
  const isFree = (x, y, z) => {
    const [i, j, k] = [cellOf(x, nx), cellOf(y, ny), cellOf(z, nz)];
    for (let c = Math.max(0, k - 2); c <= Math.min(nz - 1, k + 2); c += 1) {
      for (let b = Math.max(0, j - 2); b <= Math.min(ny - 1, j + 2); b += 1) {
        for (let a = Math.max(0, i - 2); a <= Math.min(nx - 1, i + 2); a += 1) {
          const other = 3 * grid[(c * ny + b) * nx + a];
          if (other < 0) continue;
          const [dx, dy, dz] = [points[other] - x, points[other + 1] - y, points[other + 2] - z];
          if (dx * dx + dy * dy + dz * dz < square) return false;
        }
      }
    }
    return true;
  };
  const grow = (from) => {
    for (let tries = 0; tries < TRIES; tries += 1) {
      // Uniform over the shell's volume.
      const away = least * Math.cbrt(1 + 7 * random());
      const turn = 2 * Math.PI * random();
      const up = 2 * random() - 1;
      const across = away * Math.sqrt(1 - up * up);
      const x = points[3 * from] + across * Math.cos(turn);
      const y = points[3 * from + 1] + across * Math.sin(turn);
      const z = points[3 * from + 2] + away * up;
      if (x < 0 || y < 0 || z < 0 || x >= width || y >= depth || z >= height || !isFree(x, y, z)) continue;
      add(x, y, z);
      return true;
    }
    return false;
  };
  add(random() * width, random() * depth, random() * height);
  while (active.length > 0) {
    const k = Math.floor(random() * active.length);
    if (grow(active[k])) continue;
    active[k] = active[active.length - 1];
    active.pop();
  }
  return points.slice(0, 3 * count);
}
