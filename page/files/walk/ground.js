// The ground of a leaf as a net of triangles, and what stands on it: one instance for each point of the server.

import { TRAIL, landFrom } from "./land.js";
import { KINDS } from "./shapes.js";

/** Floats of a vertex of the ground: place, normal, share of trees, distance from the trail. */
export const GROUND_FLOATS = 8;
/** Floats of an instance: place and size; turn (cos, sin), tint, rank; slope. */
export const INSTANCE_FLOATS = 10;

/** The net of a leaf: `{ floats, cells, height(x, y), slope(x, y), land }`, in distances from its corner. */
export function groundOf({ size, cx, cy }, cells) {
  const land = landFrom([cx * size, cy * size]);
  const step = size / cells;
  const across = cells + 3;
  const heights = new Float32Array(across * across);
  for (let j = 0; j < across; j += 1) {
    for (let i = 0; i < across; i += 1) heights[j * across + i] = land.height((i - 1) * step, (j - 1) * step);
  }
  const at = (i, j) => heights[(j + 1) * across + i + 1];
  const floats = [];
  const vertex = (i, j, drop) => {
    const [dx, dy] = [(at(i + 1, j) - at(i - 1, j)) / (2 * step), (at(i, j + 1) - at(i, j - 1)) / (2 * step)];
    const long = Math.hypot(dx, dy, 1);
    const [x, y] = [i * step, j * step];
    floats.push(x, y, at(i, j) - drop, -dx / long, -dy / long, 1 / long, land.trees(x, y), land.trail(x, y) / TRAIL);
  };
  for (let j = 0; j <= cells; j += 1) for (let i = 0; i <= cells; i += 1) vertex(i, j, 0);
  // A skirt around it covers the cracks to coarser neighbors.
  for (const [i, j] of rim(cells)) vertex(i, j, 0.06 * size);
  const cell = (v) => Math.min(cells - 1, Math.max(0, Math.floor(v / step)));
  return {
    floats: new Float32Array(floats), cells, land,
    height(x, y) {
      const [i, j] = [cell(x), cell(y)];
      const [u, v] = [x / step - i, y / step - j];
      const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
      // The diagonal of the net goes from the lower right to the upper left.
      return u + v < 1 ? a + (b - a) * u + (c - a) * v : d + (c - d) * (1 - u) + (b - d) * (1 - v);
    },
    slope(x, y) {
      const [i, j] = [cell(x), cell(y)];
      return [(at(i + 1, j) - at(i, j)) / step, (at(i, j + 1) - at(i, j)) / step];
    },
  };
}

/** The places of the rim, counterclockwise from the corner. */
function rim(cells) {
  const all = Array.from({ length: cells }, (_, k) => k);
  return [...all.map((k) => [k, 0]), ...all.map((k) => [cells, k]),
    ...all.map((k) => [cells - k, cells]), ...all.map((k) => [0, cells - k])];
}

/** The triangles of a net, as indices of vertices. */
export function netOf(cells) {
  const indices = [];
  const id = (i, j) => j * (cells + 1) + i;
  for (let j = 0; j < cells; j += 1) {
    for (let i = 0; i < cells; i += 1) {
      indices.push(id(i, j), id(i + 1, j), id(i, j + 1), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1));
    }
  }
  const first = (cells + 1) ** 2;
  const around = rim(cells).map(([i, j]) => id(i, j));
  around.forEach((top, k) => {
    const next = (k + 1) % around.length;
    indices.push(top, first + k, around[next], around[next], first + k, first + next);
  });
  return new Uint16Array(indices);
}

/** The variants of points, as they are requested and in the order of their indices. */
export const VARIANTS = { broad: 4, conifer: 7, rock: 1 };
const NAMES = Object.keys(VARIANTS);
const KIND = Object.fromEntries(KINDS.map((name, i) => [name, i]));

/**
 * What stands at a point, as `[kind, size]`. Trees are the points of lowest rank: as many as the land has there, and
 * the lower the rank, the taller. All others are what grows between them.
 */
function thingAt(land, x, y, variant, rank, scale, random) {
  const trees = land.trees(x, y);
  const onTrail = Math.abs(land.trail(x, y)) < 1.3 * TRAIL;
  if (variant === "rock") return [KIND.rock, onTrail ? 0.12 : (0.25 + 1.2 * random ** 5) * scale];
  if (onTrail) return [KIND.rock, 0.07 + 0.1 * random];
  if (rank < trees) {
    const tall = 1 - Math.sqrt(rank / Math.max(trees, 0.2));
    return variant === "conifer" ? [KIND.conifer, (5.5 + 10 * tall) * scale] : [KIND.broad, (5 + 6.5 * tall) * scale];
  }
  if (trees > 0.25) return variant === "broad" ? [KIND.bush, 0.9 * scale] : [KIND.tuft, 0.7 * scale];
  if (random < 0.12) return [KIND.bush, 1.2 * scale];
  return variant === "broad" ? [KIND.flower, 0.6 * scale] : [KIND.tuft, 0.75 * scale];
}

/**
 * The instances of a chunk on its ground, sorted by kind and within a kind by rank: `{ floats, runs }`, a run being
 * `{ kind, first, ranks }`. Points of a set without variants are blades of grass.
 */
export function standing(chunk, ground) {
  const { data, stride, columns } = chunk;
  const [angleAt, scaleAt, variantAt, rankAt] = ["angle", "scale", "variant", "rank"].map((name) => 2 + columns.indexOf(name));
  const things = [];
  for (let p = 0; p < data.length; p += stride) {
    const [x, y, angle, scale, rank] = [data[p], data[p + 1], data[p + angleAt], data[p + scaleAt], data[p + rankAt]];
    // The angle decides besides what the server has no number for; its leading digits are the turn.
    const random = (angle * 1021) % 1;
    const [kind, size] = variantAt > 1
      ? thingAt(ground.land, x, y, NAMES[data[p + variantAt]], rank, scale, random)
      : [KIND.blade, (Math.abs(ground.land.trail(x, y)) < 1.4 * TRAIL ? 0.12 : 0.42) * scale];
    things.push({ x, y, kind, size, rank, angle, random });
  }
  things.sort((a, b) => a.kind - b.kind || a.rank - b.rank);
  const floats = new Float32Array(things.length * INSTANCE_FLOATS);
  const runs = [];
  things.forEach(({ x, y, kind, size, rank, angle, random }, i) => {
    if (runs.at(-1)?.kind !== kind) runs.push({ kind, first: i, ranks: [] });
    runs.at(-1).ranks.push(rank);
    const slope = ground.slope(x, y);
    const all = [x, y, ground.height(x, y), size, Math.cos(angle), Math.sin(angle), random, rank, ...slope];
    floats.set(all, i * INSTANCE_FLOATS);
  });
  return { floats, runs };
}
