// Which squares of the world grid a view needs, and how many of its points.

import { distance, place, toNumber } from "./place.js";

/** More points than this are not drawn at once: beyond, the points of lowest rank stand for all. */
const MOST_POINTS = 1_000_000;
/** The least share of points that is even: fewer of them lie in rows. Beyond, density is drawn as gray. */
const LEAST_SHARE = 1 / 64;
/** The share of points from which on they fade into that gray. */
const FADING = 1 / 8;
/** The number of chunks in a view, about. */
const CHUNKS = 20;
/** No chunk is smaller than this number of spacings: a thousand points take as long to come as ten. */
const LEAST_SPACINGS = 32;
/** Along each axis no view has more chunks than this. */
const MOST_CHUNKS = 64;
/** The distance from the origin, in spacings, up to which doubles tell points apart; the server refuses what is farther. */
const REACH = 1.4e15;

/** @typedef {import("./place.js").Place} Place */
/** @typedef {Pick<import("./view.js").View, "x" | "y" | "unit" | "width" | "height">} View */

/** The side of chunks for a view, a power of two, so that corners are exact. */
export function chunkSize(/** @type {View} */ view, /** @type {number} */ spacing) {
  const side = Math.sqrt((view.width * view.height) / CHUNKS) * view.unit;
  return 2 ** Math.round(Math.log2(Math.max(side, LEAST_SPACINGS * spacing)));
}

/** The share of points to ask for: a power of two, so that what is there serves for long. */
export function shareFor(/** @type {View} */ view, /** @type {number[]} */ spacings) {
  const points = pointsIn(view, spacings);
  if (!(points > MOST_POINTS)) return 1;
  return Math.max(LEAST_SHARE, 2 ** -Math.ceil(Math.log2(points / MOST_POINTS)));
}

/** How far points have faded into gray: 0 where they are drawn as they are, 1 where a view has more than can be drawn. */
export function grayOf(view, spacings) {
  const share = MOST_POINTS / pointsIn(view, spacings);
  return Math.max(0, Math.min(1, Math.log2(share / FADING) / Math.log2(LEAST_SHARE / FADING)));
}

function pointsIn(view, spacings) {
  const area = view.width * view.height * view.unit ** 2;
  return spacings.reduce((sum, spacing) => sum + area / spacing ** 2, 0);
}

/** The index of the chunk that a coordinate is in. */
export function indexOf(/** @type {Place} */ at, /** @type {number} */ size) {
  return size >= 1 ? Math.floor(at.i / size) : at.i / size + Math.floor(at.f / size);
}

/** How far the corner of a chunk is from a coordinate: exact, as both are near each other. */
export function cornerFrom(/** @type {number} */ index, /** @type {number} */ size, /** @type {Place} */ at) {
  // The side is a power of two, so the product is exact.
  return distance(place(index * size), at);
}

/** The chunks of a view, nearest to its middle first. */
export function chunksOf(/** @type {View} */ view, /** @type {number} */ size) {
  const half = { x: (view.width * view.unit) / 2, y: (view.height * view.unit) / 2 };
  const axis = (/** @type {Place} */ at, /** @type {number} */ reach) => {
    const first = indexOf(at, size);
    const from = first + Math.floor((-reach - cornerFrom(first, size, at)) / size);
    const to = first + Math.floor((reach - cornerFrom(first, size, at)) / size);
    // Steps are counted: far out, an index and the next one are the same double.
    const steps = Math.min(MOST_CHUNKS, to - from + 1) || 0;
    return Array.from({ length: Math.max(0, steps) }, (_, step) => {
      const index = from + step;
      return { index, offset: cornerFrom(index, size, at) };
    });
  };
  const columns = axis(view.x, half.x);
  const rows = axis(view.y, half.y);
  const chunks = columns.flatMap((column) => rows.map((row) => ({
    size,
    cx: column.index,
    cy: row.index,
    away: Math.hypot(column.offset + size / 2, row.offset + size / 2),
  })));
  return chunks.sort((a, b) => a.away - b.away);
}

/** Whether a place is so far out that no doubles tell its points apart. */
export function isTooFar(/** @type {{ x: Place, y: Place }} */ { x, y }, /** @type {number} */ spacing) {
  return Math.max(Math.abs(toNumber(x)), Math.abs(toNumber(y))) > farthest(spacing);
}

/** The largest coordinate that a view can have in its middle. */
export function farthest(/** @type {number} */ spacing) {
  return REACH * spacing;
}
