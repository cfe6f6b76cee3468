// Methods that fill each unit cell of the plane by itself: they are unbounded, and every cell can be made alone.

import { UNIT, mix, stirred } from "./hash.js";

/** Calls `fill(hash, x, y)` for the cells that a window touches, x and y from its lower corner. */
function eachCell(seed, { x, y, width, height }, fill) {
  const first = mix(seed);
  const [columns, rows] = [Math.ceil(x.f + width), Math.ceil(y.f + height)];
  for (let row = 0; row < rows; row += 1) {
    const line = stirred(first, y.i + row);
    for (let column = 0; column < columns; column += 1) fill(stirred(line, x.i + column), column - x.f, row - y.f);
  }
}

/** Keeps x, y in turns if they lie in a window; a list that grows. */
function collector({ width, height }) {
  let points = new Float64Array(Math.ceil(2.2 * width * height) + 64);
  let filled = 0;
  return {
    add(x, y) {
      if (x < 0 || y < 0 || x >= width || y >= height) return;
      if (filled + 2 > points.length) {
        const larger = new Float64Array(2 * points.length);
        larger.set(points);
        points = larger;
      }
      points[filled] = x;
      points[filled + 1] = y;
      filled += 2;
    },
    all: () => points.slice(0, filled),
  };
}

/** Jittered grid: each cell has one point, anywhere in it with equal chance. */
export function jittered(seed, window) {
  const found = collector(window);
  eachCell(seed, window, (hash, left, low) => {
    const next = mix(hash + 1);
    found.add(left + next * UNIT, low + mix(next) * UNIT);
  });
  return found.all();
}

/** The chance of no point in a cell. */
const NONE = Math.exp(-1);

/**
 * White noise, a Poisson process of density 1: the number of points in a cell has the Poisson distribution of mean 1
 * (uniform numbers are multiplied until they fall below 1/e), and each lies anywhere in it.
 */
export function white(seed, window) {
  const found = collector(window);
  eachCell(seed, window, (hash, left, low) => {
    let state = mix(hash + 1);
    for (let product = state * UNIT; product > NONE; product *= state * UNIT) {
      const across = mix(state ^ 0x9e3779b9);
      state = mix(across ^ 0x85ebca6b);
      found.add(left + across * UNIT, low + state * UNIT);
      state = mix(state ^ 0xc2b2ae35);
    }
  });
  return found.all();
}

/** A square of points that is repeated: `tile` is x, y in turns within `side`. */
export function repeated({ tile, side }, window) {
  const found = collector(window);
  const { x, y, width, height } = window;
  const within = (at) => ((at.i % side) + side) % side + at.f;
  const [left, low] = [-within(x), -within(y)];
  for (let row = low; row < height; row += side) {
    for (let column = left; column < width; column += side) {
      for (let p = 0; p < tile.length; p += 2) found.add(column + tile[p], row + tile[p + 1]);
    }
  }
  return found.all();
}
