// White noise: it is unbounded, and every unit cell of the plane can be made alone.

import { UNIT, mix, stirred } from "../hash.js";

/** The chance of no point in a cell. */
const NONE = Math.exp(-1);

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
      for (let product = state * UNIT; product > NONE; product *= state * UNIT) {
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
