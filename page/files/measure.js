// The worker that measures, as a function.

import { callsOf } from "./worker.js";

const call = callsOf("/page/measure_worker.js");

/** Measures points (x, y in turns, within a square of `side` world units). */
export function measure(/** @type {Float64Array<ArrayBuffer>} */ points, /** @type {number} */ side) {
  return call({ points, side }, [points.buffer]);
}
