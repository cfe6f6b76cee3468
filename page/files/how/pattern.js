// The AA pattern of an α in the page itself: the arithmetic of the server, in integers of 2⁻⁶⁴ turns.

import { firstOf } from "../bisect.js";

const HALF = 1n << 63n;

/** The square root of an integer, rounded down. */
function root(n) {
  let x = 1n << BigInt(Math.ceil(n.toString(2).length / 2));
  for (;;) {
    const next = (x + n / x) >> 1n;
    if (next >= x) return x;
    x = next;
  }
}

/** α · 2⁶³ of the standard pattern, (5 − √3)/2, rounded to the nearest integer: √3 · 2⁶⁴ has one bit more than is kept. */
const STANDARD = ((5n << 64n) - root(3n << 128n) + 1n) >> 2n;

/** A length of index space as a number of turns. */
export function turns(value) {
  return Number(value) / 2 ** 64;
}

export class Pattern {
  /** The pattern of an α between 1 and 2, of a double; the standard one without. */
  constructor(alpha = 0) {
    const half = alpha ? BigInt(alpha * 2 ** 63) : STANDARD;
    this.half = half;
    /** The side of the set region: (α − 1)/2 turns. */
    this.side = half - HALF;
    this.t = turns(this.side);
    this.alpha = Number(half) / 2 ** 63;
    this.known = new Map();
  }

  /** {(αv + other)/2}, by the parity of the other coordinate. */
  along(v, parity) {
    const key = v * 2 + parity;
    let index = this.known.get(key);
    if (index === undefined) {
      index = BigInt.asUintN(64, this.half * BigInt(v) + (parity ? HALF : 0n));
      this.known.set(key, index);
    }
    return index;
  }

  /** The index of a grid point, as two integers. */
  index(x, y) {
    return [this.along(x, y & 1), this.along(y, x & 1)];
  }

  has(x, y) {
    return this.along(x, y & 1) < this.side && this.along(y, x & 1) < this.side;
  }

  /** The points of a square window around the origin, row by row. */
  points(reach) {
    const found = [];
    for (let y = -reach; y <= reach; y += 1) {
      for (let x = -reach; x <= reach; x += 1) if (this.has(x, y)) found.push([x, y]);
    }
    return found;
  }

  /** Where the intervals of the map of half-width R begin, ascending from 0. */
  starts(radius) {
    const all = new Set([0n]);
    for (let k = -radius; k <= radius; k += 1) {
      for (const parity of [0, 1]) {
        for (const edge of [0n, this.side]) {
          const at = BigInt.asUintN(64, edge - this.along(k, parity));
          if (at > 0n && at < this.side) all.add(at);
        }
      }
    }
    return [...all].sort((a, b) => (a < b ? -1 : 1));
  }
}

/** The interval that holds an index. */
export function intervalOf(starts, index) {
  return firstOf(starts.length, (i) => starts[i] > index) - 1;
}

/** The block of a point on a map, as text. */
export function blockOf(/** @type {Pattern} */ pattern, /** @type {bigint[]} */ starts, /** @type {number[]} */ [x, y]) {
  return pattern.index(x, y).map((index) => intervalOf(starts, index)).join();
}

/** The nearest of some points to a place. */
export function nearest(/** @type {number[][]} */ points, /** @type {number[]} */ [x, y]) {
  const far = (/** @type {number[]} */ [u, v]) => (u - x) ** 2 + (v - y) ** 2;
  return points.reduce((best, point) => (far(point) < far(best) ? point : best));
}

/**
 * The next of some points in a direction.
 * @param {number[][]} points
 * @param {number[]} place
 * @param {number[]} direction
 * @returns {number[] | null}
 */
export function nextOf(points, [x, y], [right, up]) {
  const along = (/** @type {number[]} */ [u, v]) => (u - x) * right + (v - y) * up;
  const aside = (/** @type {number[]} */ [u, v]) => Math.abs((u - x) * up) + Math.abs((v - y) * right);
  const ahead = points.filter((point) => along(point) > 0 && aside(point) <= along(point));
  const cost = (point) => along(point) + 2 * aside(point);
  return ahead.sort((a, b) => cost(a) - cost(b))[0] ?? null;
}
