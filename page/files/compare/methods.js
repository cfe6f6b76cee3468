// The ways to scatter points that are compared: what each is, and where it comes from.

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
