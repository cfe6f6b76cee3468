// Makes the sets beside Strew's, and measures distances, off the page's own thread.

import { streamOf } from "../compare/hash.js";
import { bridson } from "./bridson.js";
import { distancesOf } from "./distances.js";

/** Points by chance, one a unit volume. */
function chance(seed, sides) {
  const random = streamOf(seed);
  const count = Math.round(sides[0] * sides[1] * sides[2]);
  return Float64Array.from({ length: 3 * count }, (_, i) => random() * sides[i % 3]);
}

// `points` are x, y, z in a box of these sides in mean spacings; without them, `method` says how they are made.
addEventListener("message", ({ data: { id, method, seed, sides, margin, points } }) => {
  const own = points ?? (method === "poisson" ? bridson(seed, sides) : chance(seed, sides));
  postMessage({ id, points: own, distances: distancesOf(own, sides, margin) }, { transfer: [own.buffer] });
});
