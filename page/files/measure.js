// The worker that measures, as a function.

import { callsOf } from "./worker.js";

const call = callsOf("/page/measure_worker.js");

/**
 * Measures points (x, y in turns, within a square of `side` world units).
 * @param {Float64Array<ArrayBuffer>} points
 * @param {number} side
 */
export function measure(points, side) {
  return call({ points, side }, [points.buffer]);
}
