// Which squares are drawn around a place: small ones with all of their points nearby, larger ones with fewer points
// farther away. A square twice as wide holds a quarter of the points, those of the lowest rank: every square has about
// as many, and a point that is drawn far away is one of those that are drawn nearby.

import { cornerFrom, indexOf } from "../grid.js";

/** The places of leaves follow the walker in steps of this many units, not with every frame. */
export const STEP = 4;

/**
 * The squares around a place, nearest first: `{ level, size, cx, cy, keep, away, from }`, where `from` is where the
 * corner is, seen from the place.
 *
 * `base` is the side of the smallest, `near` how far all points are drawn, `reach` how far any are.
 */
export function leavesAround(at, { base, near, reach }) {
  const leaves = [];
  const top = Math.max(0, Math.ceil(Math.log2(reach / near)) - 1);
  const visit = (level, cx, cy) => {
    const size = base * 2 ** level;
    const from = [cornerFrom(cx, size, at.x), cornerFrom(cy, size, at.y)];
    const outside = from.map((corner) => Math.max(0, corner, -corner - size));
    const away = Math.hypot(...outside);
    if (away > reach) return;
    // The share that is drawn at a distance d is (near ÷ d)²; a step of the walker changes nothing of it.
    if (level > 0 && away - 2 * STEP < near * 2 ** level) {
      for (const [i, j] of [[0, 0], [1, 0], [0, 1], [1, 1]]) visit(level - 1, 2 * cx + i, 2 * cy + j);
      return;
    }
    leaves.push({ level, size, cx, cy, keep: 4 ** -level, away, from });
  };
  const size = base * 2 ** top;
  const rings = Math.ceil(reach / size);
  const [x, y] = [indexOf(at.x, size), indexOf(at.y, size)];
  for (let j = -rings; j <= rings; j += 1) {
    for (let i = -rings; i <= rings; i += 1) visit(top, x + i, y + j);
  }
  return leaves.sort((a, b) => a.away - b.away);
}

/** The name of a leaf. */
export function nameOf({ level, cx, cy }) {
  return `${level}/${cx}/${cy}`;
}

/**
 * What is drawn for a leaf: itself if `ready` has it, else a larger square around it, of which only the leaf's part is
 * drawn, else the parts of it that are there. Each comes with the leaf's own square as its `clip`.
 */
export function standIns(leaf, ready, deepest = 2) {
  if (ready(leaf)) return [{ leaf, clip: null }];
  let above = leaf;
  for (let i = 0; i < 5; i += 1) {
    above = {
      level: above.level + 1, size: above.size * 2, keep: above.keep / 4, away: leaf.away,
      cx: Math.floor(above.cx / 2), cy: Math.floor(above.cy / 2),
      from: above.from.map((corner, axis) => corner - above.size * (Math.abs(axis ? above.cy : above.cx) % 2)),
    };
    if (ready(above)) return [{ leaf: above, clip: [...leaf.from, leaf.size] }];
  }
  if (leaf.level === 0 || deepest === 0) return [];
  const size = leaf.size / 2;
  return [[0, 0], [1, 0], [0, 1], [1, 1]].flatMap(([i, j]) => standIns({
    level: leaf.level - 1, size, keep: leaf.keep * 4, away: leaf.away,
    cx: 2 * leaf.cx + i, cy: 2 * leaf.cy + j, from: [leaf.from[0] + i * size, leaf.from[1] + j * size],
  }, ready, deepest - 1).filter(({ clip }) => !clip));
}
