// Distances between points of a window: nearest neighbors, and how often each distance occurs.

/** Distances are counted up to this number of mean spacings, in bins of this width. */
const REACH = 5;
const BIN = 0.04;

/** Of points x, y in a square of `side` mean spacings: `{ least, mean, rdf }`, in mean spacings. */
export function neighborsOf(points, side) {
  const count = points.length / 2;
  const reach = Math.min(REACH, side / 4);
  const across = Math.max(1, Math.floor(side));
  /** @type {number[][]} */
  const cells = Array.from({ length: across * across }, () => []);
  const cell = (v) => Math.min(across - 1, Math.max(0, Math.floor((v / side) * across)));
  for (let p = 0; p < count; p += 1) cells[cell(points[2 * p + 1]) * across + cell(points[2 * p])].push(p);
  const bins = new Float64Array(Math.ceil(reach / BIN));
  const rings = Math.ceil((reach * across) / side);
  let [least, sum, inner] = [Infinity, 0, 0];
  for (let p = 0; p < count; p += 1) {
    const [x, y] = [points[2 * p], points[2 * p + 1]];
    // Only points with all of their surroundings in view count as middles; every pair counts for
    // the least distance.
    const isInner = Math.min(x, y) >= reach && Math.max(x, y) <= side - reach;
    const around = isInner ? rings : 1;
    let nearest = Infinity;
    for (let j = Math.max(0, cell(y) - around); j <= Math.min(across - 1, cell(y) + around); j += 1) {
      for (let i = Math.max(0, cell(x) - around); i <= Math.min(across - 1, cell(x) + around); i += 1) {
        for (const q of cells[j * across + i]) {
          if (q === p) continue;
          const away = Math.hypot(points[2 * q] - x, points[2 * q + 1] - y);
          nearest = Math.min(nearest, away);
          if (isInner && away < reach) bins[Math.floor(away / BIN)] += 1;
        }
      }
    }
    least = Math.min(least, nearest);
    if (!isInner) continue;
    sum += nearest;
    inner += 1;
  }
  const rdf = [...bins].map((pairs, i) => {
    const area = Math.PI * BIN * BIN * (2 * i + 1);
    return [(i + 0.5) * BIN, pairs / (area * Math.max(1, inner))];
  });
  return { least, mean: inner > 0 ? sum / inner : NaN, rdf };
}
