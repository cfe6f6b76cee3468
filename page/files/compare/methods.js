// The ways to scatter points that are compared: what each is, where it comes from, and the number of points that it has to
// make before it can show a window.

import { toNumber } from "../place.js";

/** The side of the square that is measured, in mean spacings. */
export const MEASURED = 100;
/**
 * The methods in the order of the page. `box` is the region of those that have one: it is chosen before the first
 * point is made.
 */
export const METHODS = [
  {
    id: "strew",
    name: "Strew",
    words: "A point is computed from its own place in an AA pattern and a small table. No point is stored, and none "
      + "is repeated.",
    source: "Ahmed, Huang, Deussen 2015: AA Patterns for Point Sets with Controlled Spectral Properties.",
  },
  {
    id: "poisson",
    name: "Poisson disk",
    box: [-128, -128, 128, 128],
    words: "Places around existing points are tried, 30 for each point, and kept if no point is nearer than r, here "
      + "0.786 of the mean spacing. Variants that can be made in parts exist: from tiles, which repeat, or with the "
      + "cells of a grid taken in a fixed order.",
    source: "Bridson 2007: Fast Poisson Disk Sampling in Arbitrary Dimensions.",
  },
  {
    id: "white",
    name: "White noise",
    words: "Pure chance, a Poisson process: each unit cell has 0, 1, 2, … points with the chances of a mean of 1.",
    source: "Knuth 1969: The Art of Computer Programming, volume 2, 3.4.1.",
  },
];

/** The region of a method that has one: `[left, low, right, top]`. */
export function boxOf(id) {
  return METHODS.find((method) => method.id === id)?.box;
}

const SECONDS = { years: 31_557_600, days: 86_400, hours: 3600, minutes: 60 };
const DIGITS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A number in full, or as a power of ten where it is long. */
export function large(value) {
  if (value < 1e12) return Math.round(value).toLocaleString("en");
  const power = Math.floor(Math.log10(value));
  const raised = [...String(power)].map((digit) => DIGITS[digit]).join("");
  return `${Math.round(value / 10 ** power)} × 10${raised}`;
}

/** A time in the largest unit that it has one of. */
export function lasting(seconds) {
  const [unit, size] = Object.entries(SECONDS).find(([, one]) => seconds >= 2 * one) ?? ["seconds", 1];
  const count = seconds / size;
  return `${large(Number(count.toPrecision(count >= 1 ? 2 : 1)))} ${unit}`;
}

/** The points of a square around the origin, with one point a unit area, that holds all of a window. */
export function upTo({ x, y, width, height }) {
  const reach = Math.max(...[[x, width], [y, height]].flatMap(([at, side]) => [Math.abs(toNumber(at)), Math.abs(toNumber(at) + side)]));
  return (2 * reach) ** 2;
}

const ALONE = {
  strew: "These and no others. Each follows from its own place, so any window can be made alone, here or anywhere.",
  white: "These and no others: each cell is made alone, from a hash of its place.",
};

/**
 * What a method makes for a window: `{ made, words, why }`. `seen` points of it are in the window, `isOutside` says that
 * the window is outside of its region, `total` is the number of points that were made for it, and `nanoseconds` the
 * time of each, as far as that is known.
 */
export function priceOf(id, window, { seen, total, isOutside, nanoseconds }) {
  if (ALONE[id]) return { made: seen, words: `${seen === 1 ? "point" : "points"} made to show ${large(seen)}`, why: ALONE[id] };
  if (!isOutside) {
    const why = "All of its square of 256 × 256: whether a point fits depends on its neighbors, on theirs, and so on back to the first.";
    return { made: total, words: `points made to show ${large(seen)}`, why };
  }
  const made = upTo(window);
  const time = nanoseconds ? `, about ${lasting((made * nanoseconds) / 1e9)} in this browser` : "";
  const why = `Everything from its first point to here${time}. Begun afresh here, it is another set, with a seam where the two meet.`;
  return { made, words: "points to make first", why };
}
