// A good tile: points on a torus that repel each other by a Gaussian until they lie evenly (Gaussian blue noise:
// A. G. M. Ahmed, J. Ren, P. Wonka, 2022).

import { streamOf } from "./hash.js";

/** Points farther apart than this, in mean spacings, hardly feel each other. */
const REACH = 5;
/** Steps of the descent, their length and how much of a step is kept for the next one. */
const STEPS = 160;
const STEP = 0.6;
const KEPT = 0.9;

/** The push of each point by all others, as x, y in turns, on a torus of `side` unit cells. */
function pushes(points, side, push) {
  push.fill(0);
  /** @type {number[][]} */
  const cells = Array.from({ length: side * side }, () => []);
  for (let p = 0; p < points.length; p += 2) cells[Math.floor(points[p + 1]) * side + Math.floor(points[p])].push(p);
  const nearest = (d) => (d > side / 2 ? d - side : d < -side / 2 ? d + side : d);
  for (let p = 0; p < points.length; p += 2) {
    const [x, y] = [points[p], points[p + 1]];
    for (let j = -REACH; j <= REACH; j += 1) {
      for (let i = -REACH; i <= REACH; i += 1) {
        const row = (Math.floor(y) + j + side) % side;
        for (const q of cells[row * side + ((Math.floor(x) + i + side) % side)]) {
          if (q <= p) continue;
          const [dx, dy] = [nearest(x - points[q]), nearest(y - points[q + 1])];
          const strength = Math.exp(-(dx * dx + dy * dy) / 2);
          push[p] += strength * dx;
          push[p + 1] += strength * dy;
          push[q] -= strength * dx;
          push[q + 1] -= strength * dy;
        }
      }
    }
  }
}

/** side² points x, y in turns in a square of `side` that repeats without a seam. */
export function tileOf(seed, side) {
  const random = streamOf(seed);
  const points = Float64Array.from({ length: 2 * side * side }, (_, k) => {
    const cell = Math.floor(k / 2);
    return (k % 2 === 0 ? cell % side : Math.floor(cell / side)) + random();
  });
  const push = new Float64Array(points.length);
  const speed = new Float64Array(points.length);
  for (let step = 0; step < STEPS; step += 1) {
    pushes(points, side, push);
    for (let k = 0; k < points.length; k += 1) {
      speed[k] = KEPT * speed[k] + STEP * push[k];
      points[k] = ((points[k] + speed[k]) % side + side) % side;
    }
  }
  return points;
}
