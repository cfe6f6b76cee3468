// Distances of points in a box of space from their nearest neighbors.

/** The nearest-neighbor distance of the densest packing of spheres at one point a unit volume. */
const PACKED = Math.SQRT2 ** (1 / 3);

/**
 * The least and the mean distance from a point to its nearest neighbor, as shares of the densest packing's. `points` are
 * x, y, z in turns in mean spacings; those nearer than `margin` to a side of the box are neighbors only.
 */
export function distancesOf(points, sides, margin) {
  const cells = new Map();
  const [nx, ny] = sides.map((side) => Math.ceil(side) + 2);
  const keyOf = (x, y, z) => ((z + 1) * ny + y + 1) * nx + x + 1;
  for (let p = 0; p < points.length; p += 3) {
    const key = keyOf(Math.floor(points[p]), Math.floor(points[p + 1]), Math.floor(points[p + 2]));
    if (cells.has(key)) cells.get(key).push(p);
    else cells.set(key, [p]);
  }
  const nearest = (p) => {
    const [i, j, k] = [0, 1, 2].map((axis) => Math.floor(points[p + axis]));
    let best = Infinity;
    for (let reach = 1; reach <= margin && best > reach * reach; reach += 1) {
      for (let c = k - reach; c <= k + reach; c += 1) {
        for (let b = j - reach; b <= j + reach; b += 1) {
          for (let a = i - reach; a <= i + reach; a += 1) {
            for (const q of cells.get(keyOf(a, b, c)) ?? []) {
              if (q === p) continue;
              const [dx, dy, dz] = [points[p] - points[q], points[p + 1] - points[q + 1], points[p + 2] - points[q + 2]];
              best = Math.min(best, dx * dx + dy * dy + dz * dz);
            }
          }
        }
      }
    }
    return Math.sqrt(best);
  };
  let [least, sum, count] = [Infinity, 0, 0];
  for (let p = 0; p < points.length; p += 3) {
    if (sides.some((side, axis) => points[p + axis] < margin || points[p + axis] >= side - margin)) continue;
    const away = nearest(p);
    least = Math.min(least, away);
    sum += away;
    count += 1;
  }
  return { least: least / PACKED, mean: sum / count / PACKED, count };
}
