// The ways to scatter points that are compared: what each is, and where it comes from.

/** The side of the square that is measured, in mean spacings. */
export const MEASURED = 100;
/** The side of the tile, in mean spacings. */
export const TILE = 16;

/** A box with the origin in its middle: `[left, low, right, top]`. */
const around = (width, height) => [-width / 2, -height / 2, width / 2, height / 2];

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
    box: around(256, 256),
    words: "Places around existing points are tried, 30 for each point, and kept if no point is nearer than r, here "
      + "0.786 of the mean spacing. Variants that can be made in parts exist: from tiles, which repeat, or with the "
      + "cells of a grid taken in a fixed order.",
    source: "Bridson 2007: Fast Poisson Disk Sampling in Arbitrary Dimensions.",
  },
  {
    id: "tile",
    name: "Repeated tile",
    words: `${(TILE * TILE).toLocaleString("en")} points on a torus push each other apart until they lie evenly; the `
      + "square is then repeated, so its spectrum falls into dots.",
    source: "Ahmed, Ren, Wonka 2022: Gaussian Blue Noise.",
  },
  {
    id: "jitter",
    name: "Jittered grid",
    words: "Every unit cell has one point, anywhere in it with equal chance; neighbors may touch across an edge.",
    source: "Cook 1986: Stochastic Sampling in Computer Graphics.",
  },
  {
    id: "halton",
    name: "Halton",
    box: around(256, 243),
    words: "Point i is the number i in base 2 across and in base 3 upward, each with its digits mirrored. There is no "
      + "seed. The numbers of the points in a window can be solved for; this page counts through all of them.",
    source: "Halton 1960: On the Efficiency of Certain Quasi-Random Sequences of Points.",
  },
  {
    id: "white",
    name: "White noise",
    words: "Pure chance, a Poisson process: each unit cell has 0, 1, 2, … points with the chances of a mean of 1.",
    source: "Knuth 1969: The Art of Computer Programming, volume 2, 3.4.1.",
  },
];

/** The method of a name. */
export function methodOf(id) {
  return METHODS.find((method) => method.id === id);
}

/** The region of a method that has one: `[left, low, right, top]`. */
export function boxOf(id) {
  const method = methodOf(id);
  return method && "box" in method ? method.box : undefined;
}
