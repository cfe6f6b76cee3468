// The ways to scatter points that are compared: what each is, where it comes from, and what it can do far away.

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
    far: "Unbounded: any place at once, no point stored, none repeated.",
    words: "A point is computed from its own place in an AA pattern and a small table, so every view has its exact "
      + "points, however far out.",
    source: "Ahmed, Huang, Deussen 2015: AA Patterns for Point Sets with Controlled Spectral Properties.",
  },
  {
    id: "poisson",
    name: "Poisson disk",
    box: around(256, 256),
    far: "Bounded: a square of 256 × 256, built whole before any part of it is known. A larger square is another set.",
    words: "Places are tried around points that are there, 30 times each, and kept if none lies nearer than r, here "
      + "0.786 of the mean spacing.",
    source: "Bridson 2007: Fast Poisson Disk Sampling in Arbitrary Dimensions.",
  },
  {
    id: "tile",
    name: "Repeated tile",
    far: `Unbounded, but the same ${TILE} × ${TILE} again and again: its spectrum falls into dots.`,
    words: `${(TILE * TILE).toLocaleString("en")} points on a torus push each other apart until they lie evenly; the `
      + "square is then repeated.",
    source: "Ahmed, Ren, Wonka 2022: Gaussian Blue Noise.",
  },
  {
    id: "jitter",
    name: "Jittered grid",
    far: "Unbounded: each cell is made alone, from a hash of its place.",
    words: "Every unit cell has one point, anywhere in it with equal chance; neighbors may touch across a side.",
    source: "Cook 1986: Stochastic Sampling in Computer Graphics.",
  },
  {
    id: "halton",
    name: "Halton",
    box: around(256, 243),
    far: "Unbounded only by counting: further points fall between those that are there. Here its first 62,208 "
      + "points fill 256 × 243; it has no seed.",
    words: "Point i is the number i in base 2 across and in base 3 upward, each with its digits mirrored.",
    source: "Halton 1960: On the Efficiency of Certain Quasi-Random Sequences of Points.",
  },
  {
    id: "white",
    name: "White noise",
    far: "Unbounded: each cell is made alone, from a hash of its place.",
    words: "Pure chance, a Poisson process: each unit cell has 0, 1, 2, … points with the chances of a mean of 1.",
    source: "Knuth 1969: The Art of Computer Programming, volume 2, 3.4.1.",
  },
];

/** The method of a name. */
export function methodOf(id) {
  return METHODS.find((method) => method.id === id);
}
