// The land: heights, woods and a trail as functions of the place alone, from seeded value noise. Nothing of it comes
// from the server, and nothing is kept: any place can be looked at, however far out it is.
//
// Wavelengths are powers of two and corners are integers, so that cells of the noise are found exactly at 1e15 as well.

/** A well mixed number of 32 bits of the cell of two indices and a seed. */
function hashed(i, j, seed) {
  let h = seed ^ Math.imul(i >>> 0, 0x9e3779b1) ^ Math.imul(Math.floor(i / 2 ** 32) | 0, 0x85ebca77);
  h = Math.imul(h ^ (h >>> 15), 0x2c1b3c6d);
  h ^= Math.imul(j >>> 0, 0xc2b2ae3d) ^ Math.imul(Math.floor(j / 2 ** 32) | 0, 0x27d4eb2f);
  h = Math.imul(h ^ (h >>> 15), 0x85ebca6b);
  h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
  return (h ^ (h >>> 16)) >>> 0;
}

const eased = (t) => t * t * t * (t * (6 * t - 15) + 10);
const between = (from, to, v) => {
  const t = Math.min(1, Math.max(0, (v - from) / (to - from)));
  return t * t * (3 - 2 * t);
};

/** A wave of noise as seen from a corner: a function of the distances from there, with values from 0 to 1. */
function wave([x, y], length, seed) {
  const [i, j] = [Math.floor(x / length), Math.floor(y / length)];
  const [dx, dy] = [x - i * length, y - j * length];
  const known = new Map();
  const knot = (a, b) => {
    const key = a * 4096 + b;
    let value = known.get(key);
    if (value === undefined) known.set(key, (value = hashed(i + a, j + b, seed) / 2 ** 32));
    return value;
  };
  return (px, py) => {
    const [u, v] = [(dx + px) / length, (dy + py) / length];
    const [a, b] = [Math.floor(u), Math.floor(v)];
    const [s, t] = [eased(u - a), eased(v - b)];
    const low = knot(a, b) + (knot(a + 1, b) - knot(a, b)) * s;
    const high = knot(a, b + 1) + (knot(a + 1, b + 1) - knot(a, b + 1)) * s;
    return low + (high - low) * t;
  };
}

/** Wavelengths of the hills and how high each makes them, in units of the plane. */
const HILLS = [[1024, 120], [512, 46], [256, 17], [64, 3], [32, 0.9]];
/** How far the trail's noise may be from ½ on the trail. */
export const TRAIL = 0.0095;

/** The land as seen from a corner: all functions take distances from there. */
export function landFrom(corner) {
  const hills = HILLS.map(([length, height], i) => ({ noise: wave(corner, length, 11 + i), height }));
  const [woods, edges, way] = [wave(corner, 128, 31), wave(corner, 32, 32), wave(corner, 256, 41)];
  const trail = (x, y) => way(x, y) - 0.5;
  return {
    height: (x, y) => hills.reduce((sum, { noise, height }) => sum + height * noise(x, y), 0),
    /** The share of points that are trees: those of the lowest rank. */
    trees: (x, y) => {
      const share = between(0.36, 0.58, 0.72 * woods(x, y) + 0.28 * edges(x, y));
      return (0.015 + 0.62 * share) * between(1.4 * TRAIL, 4 * TRAIL, Math.abs(trail(x, y)));
    },
    /** Zero in the middle of the trail, below `TRAIL` on it. */
    trail,
  };
}

/** How far apart places are tried for a clearing, and how far out. */
const STEP = 12;
const FARTHEST = 640;
/** Rings of places around one that decide how clear it is, in units, and the places of a ring. */
const RINGS = [4, 10, 18, 28];
const AROUND = 12;
/** Directions that are tried for a view, and the distances that it is judged at. */
const VIEWS = 24;
const SEEN = [8, 16, 24, 36, 50, 70, 95];

/** Calls `visit(x, y)` for places on a circle around the origin. */
function circle(radius, count, visit) {
  for (let k = 0; k < count; k += 1) {
    const turn = (2 * Math.PI * k) / count;
    visit(radius * Math.sin(turn), radius * Math.cos(turn), turn);
  }
}

/** The mean share of trees around a place, and how far it is from the trail. */
function closeness(land, x, y) {
  let [sum, weight] = [land.trees(x, y), 1];
  for (const radius of RINGS) {
    circle(radius, AROUND, (dx, dy) => {
      sum += land.trees(x + dx, y + dy);
      weight += 1;
    });
  }
  return sum / weight + 0.04 * Math.min(2, Math.max(0, Math.abs(land.trail(x, y)) / TRAIL - 0.5));
}

/**
 * A clearing near a place, on the trail where there is one, as `{ dx, dy, yaw }`: how far it is from the corner that
 * the land is seen from, and the direction with the widest view. `few` is the share of trees that is clear enough.
 */
export function clearingNear(land, fromX, fromY, few = 0.012) {
  let best = { dx: fromX, dy: fromY, close: Infinity };
  const visit = (x, y) => {
    const close = closeness(land, x, y);
    if (close < best.close) best = { dx: x, dy: y, close };
  };
  visit(fromX, fromY);
  for (let radius = STEP; radius <= FARTHEST && best.close > few; radius += STEP) {
    circle(radius, Math.ceil((2 * Math.PI * radius) / STEP), (dx, dy) => visit(fromX + dx, fromY + dy));
  }
  // The middle of the trail, and of the clearing, is nearby.
  for (const radius of [4, 2, 1]) {
    const { dx, dy } = best;
    circle(radius, AROUND, (x, y) => visit(dx + x, dy + y));
  }
  return { ...best, yaw: viewFrom(land, best.dx, best.dy) };
}

/** The direction in which trees and slopes hide least. */
function viewFrom(land, x, y) {
  const here = land.height(x, y);
  let best = { hidden: Infinity };
  circle(1, VIEWS, (dx, dy, yaw) => {
    const hidden = SEEN.reduce((sum, away) => {
      const [px, py] = [x + away * dx, y + away * dy];
      return sum + land.trees(px, py) + Math.max(0, (land.height(px, py) - here) / away - 0.05);
    }, 0);
    if (hidden < best.hidden) best = { hidden, yaw };
  });
  return best.yaw;
}
