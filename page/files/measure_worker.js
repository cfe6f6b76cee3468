// Measures points off the page's own thread: a message with points is answered by one with figures.

import { neighborsOf } from "./neighbors.js";
import { spectrumOf } from "./spectrum.js";

/** Nearest-neighbor distances are in units of that of the densest packing. */
const HEXAGONAL = Math.sqrt(2 / Math.sqrt(3));

// `points` are x, y within a square of `side` world units.
addEventListener("message", ({ data: { id, points, side } }) => {
  const count = points.length / 2;
  const spacing = side / Math.sqrt(count);
  const scaled = points.map((v) => v / spacing);
  const across = Math.sqrt(count);
  const { least, mean, rdf } = neighborsOf(scaled, across);
  const { image, cells, radial } = spectrumOf(scaled, across);
  const figures = { count, spacing, least, mean, deltaMin: least / HEXAGONAL, deltaAvg: mean / HEXAGONAL };
  postMessage({ id, figures, rdf, radial, image, cells }, { transfer: [image.buffer] });
});
