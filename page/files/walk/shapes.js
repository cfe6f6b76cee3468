// Trees, rocks and plants as triangles, by code. Each is one unit high and stands on the origin; a vertex is a place,
// a normal and a color.

import { streamOf } from "../hash.js";

const TAU = 2 * Math.PI;

/** Floats of a vertex. */
export const VERTEX_FLOATS = 9;

const minus = (a, b) => a.map((v, i) => v - b[i]);
const unit = (a) => a.map((v) => v / (Math.hypot(...a) || 1));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Triangles that grow. `shade` is a color, or a color by height. */
class Shape {
  constructor() {
    this.floats = [];
  }

  /** A triangle, whose normal leans by `round` to that away from `middle`. */
  face(corners, color, middle, round = 0) {
    const flat = unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])));
    for (const corner of corners) {
      const away = unit(minus(corner, middle ?? corner));
      const normal = middle ? unit(flat.map((v, i) => v * (1 - round) + away[i] * round)) : flat;
      this.floats.push(...corner, ...normal, ...(typeof color === "function" ? color(corner[2]) : color));
    }
  }

  /** A ring of faces from one circle to another above it; a radius of 0 is a tip. */
  cone(sides, [low, below], [high, above], color, turn = 0, jag = 0) {
    const at = (radius, z, i) => {
      const angle = turn + (TAU * i) / sides;
      const out = radius * (1 + (i % 2 ? jag : -jag));
      return [out * Math.cos(angle), out * Math.sin(angle), z];
    };
    const middle = [0, 0, (low + high) / 2 - below];
    for (let i = 0; i < sides; i += 1) {
      const next = (i + 1) % sides;
      this.face([at(below, low, i), at(below, low, next), at(above, high, i)], color, middle, 0.35);
      if (above > 0) this.face([at(below, low, next), at(above, high, next), at(above, high, i)], color, middle, 0.35);
    }
  }

  /** A ball with dents, stretched to its radii. */
  ball(center, radii, color, { splits = 0, dent = 0.12, round = 0.6, seed = 1, faces = ICOSAHEDRON } = {}) {
    const random = streamOf(seed);
    const dents = new Map();
    const place = (corner) => {
      const key = corner.map((v) => v.toFixed(3)).join();
      if (!dents.has(key)) dents.set(key, 1 + dent * (2 * random() - 1));
      return corner.map((v, i) => center[i] + v * radii[i] * dents.get(key));
    };
    for (const corners of split(faces, splits)) this.face(corners.map(place), color, center, round);
  }
}

/** The faces of a solid, by the numbers of its corners. */
function solid(corners, faces) {
  return faces.map((face) => face.split(" ").map((i) => unit(corners[i])));
}

const T = (1 + Math.sqrt(5)) / 2;
const ICOSAHEDRON = solid(
  [[-1, T, 0], [1, T, 0], [-1, -T, 0], [1, -T, 0], [0, -1, T], [0, 1, T], [0, -1, -T], [0, 1, -T],
    [T, 0, -1], [T, 0, 1], [-T, 0, -1], [-T, 0, 1]],
  ["0 11 5", "0 5 1", "0 1 7", "0 7 10", "0 10 11", "1 5 9", "5 11 4", "11 10 2", "10 7 6", "7 1 8",
    "3 9 4", "3 4 2", "3 2 6", "3 6 8", "3 8 9", "4 9 5", "2 4 11", "6 2 10", "8 6 7", "9 8 1"],
);
const OCTAHEDRON = solid(
  [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
  ["0 2 4", "2 1 4", "1 3 4", "3 0 4", "2 0 5", "1 2 5", "3 1 5", "0 3 5"],
);

/** Faces of a ball, each split in four a number of times. */
function split(faces, splits) {
  let all = faces;
  for (let n = 0; n < splits; n += 1) {
    all = all.flatMap(([a, b, c]) => {
      const half = (p, q) => unit(p.map((v, i) => v + q[i]));
      const [ab, bc, ca] = [half(a, b), half(b, c), half(c, a)];
      return [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
    });
  }
  return all;
}

/** A color that becomes another one between two heights. */
const fade = (from, to, low, high) => (z) => {
  const t = Math.min(1, Math.max(0, (z - low) / (high - low)));
  return from.map((v, i) => v + (to[i] - v) * t);
};

const BARK = [0.30, 0.22, 0.16];
const NEEDLES = fade([0.10, 0.22, 0.15], [0.24, 0.42, 0.25], 0.1, 1);
const LEAVES = fade([0.17, 0.28, 0.12], [0.38, 0.49, 0.22], 0.3, 0.95);
const STONE = fade([0.33, 0.32, 0.30], [0.62, 0.61, 0.58], 0, 0.8);
const BUSH = fade([0.15, 0.24, 0.10], [0.36, 0.48, 0.20], 0, 0.9);
const BLADE = fade([0.20, 0.28, 0.10], [0.55, 0.62, 0.28], 0, 1);

function conifer(isFar) {
  const shape = new Shape();
  const sides = isFar ? 5 : 8;
  shape.cone(isFar ? 3 : 6, [0, 0.028], [0.3, 0.02], BARK);
  const tiers = isFar ? [[0.12, 0.21, 0.66], [0.42, 0.15, 1]]
    : [[0.12, 0.22, 0.5], [0.28, 0.185, 0.66], [0.46, 0.145, 0.82], [0.64, 0.1, 1]];
  tiers.forEach(([low, radius, high], i) => shape.cone(sides, [low, radius], [high, 0], NEEDLES, i * 0.7, isFar ? 0 : 0.09));
  return shape;
}

function broad(isFar) {
  const shape = new Shape();
  shape.cone(isFar ? 3 : 6, [0, 0.042], [0.5, 0.026], BARK);
  if (isFar) shape.ball([0, 0, 0.66], [0.31, 0.31, 0.34], LEAVES, { seed: 5 });
  else {
    shape.ball([0, 0.02, 0.70], [0.27, 0.27, 0.29], LEAVES, { splits: 1, dent: 0.1, seed: 5 });
    shape.ball([0.16, -0.07, 0.53], [0.19, 0.19, 0.17], LEAVES, { seed: 6 });
    shape.ball([-0.15, 0.1, 0.56], [0.18, 0.18, 0.18], LEAVES, { seed: 7 });
  }
  return shape;
}

function rock(isFar) {
  const shape = new Shape();
  const form = { splits: isFar ? 0 : 1, dent: 0.14, round: 0.1, seed: 3, faces: isFar ? OCTAHEDRON : ICOSAHEDRON };
  shape.ball([0, 0, 0.25], [0.75, 0.6, 0.62], STONE, form);
  return shape;
}

function bush(isFar) {
  const shape = new Shape();
  shape.ball([0, 0, 0.4], [0.62, 0.62, 0.55], BUSH, { seed: 9, faces: isFar ? OCTAHEDRON : ICOSAHEDRON });
  if (!isFar) shape.ball([0.42, 0.22, 0.28], [0.42, 0.4, 0.4], BUSH, { seed: 10 });
  return shape;
}

/** Blades of grass, with heads of a color where there is one. */
function tuft(isFar, heads) {
  const shape = new Shape();
  const blades = isFar ? 3 : 7;
  for (let i = 0; i < blades; i += 1) {
    const angle = (TAU * i) / blades + (i % 2) * 0.4;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const tall = 1 - 0.28 * (i % 3);
    const tip = [0.34 * c * tall, 0.34 * s * tall, tall];
    shape.face([[-0.09 * s, 0.09 * c, 0], [0.09 * s, -0.09 * c, 0], tip], BLADE);
    if (heads && i % 2 === 0) shape.ball(tip, [0.1, 0.1, 0.09], heads, { round: 0.9, dent: 0, faces: OCTAHEDRON });
  }
  return shape;
}

/** The kinds by name: what stands there, in the order in which it is drawn. */
export const KINDS = ["conifer", "broad", "rock", "bush", "tuft", "flower", "blade"];

const MAKERS = [conifer, broad, rock, bush, tuft, (isFar) => tuft(isFar, [0.86, 0.78, 0.34]), (isFar) => tuft(isFar)];

/** A cone with four sides. */
function spike(low, below, high, color) {
  const shape = new Shape();
  shape.cone(4, [low, below], [high, 0], color);
  return shape;
}

/** A single blade. */
function sprout(color) {
  const shape = new Shape();
  shape.face([[-0.2, 0, 0], [0.2, 0.1, 0], [0.05, 0.1, 0.9]], color);
  return shape;
}

/** A crown that is round from the side, and open below. */
function crown() {
  const shape = new Shape();
  shape.cone(4, [0.2, 0.22], [0.45, 0.34], LEAVES, 0.4);
  shape.cone(4, [0.45, 0.34], [0.86, 0.2], LEAVES, 0.4);
  shape.cone(4, [0.86, 0.2], [0.96, 0], LEAVES, 0.4);
  return shape;
}

/** The same kinds with as few triangles as can be, for processors that draw without graphics hardware. */
const PLAIN = [
  () => spike(0.04, 0.2, 1, NEEDLES), crown, () => spike(0, 0.7, 0.62, STONE), () => spike(0, 0.66, 0.85, BUSH),
  () => sprout(BLADE), () => sprout(fade(BLADE(0), [0.86, 0.78, 0.34], 0.3, 0.9)), () => sprout(BLADE),
];

/** All shapes in one array: `{ floats, near, far, plain }` with the runs `[first, count]` of each kind's vertices. */
export function allShapes() {
  const floats = [];
  const run = (shape) => {
    const first = floats.length / VERTEX_FLOATS;
    for (const value of shape.floats) floats.push(value);
    return [first, shape.floats.length / VERTEX_FLOATS];
  };
  const near = MAKERS.map((maker) => run(maker(false)));
  const far = MAKERS.map((maker) => run(maker(true)));
  const plain = PLAIN.map((maker) => run(maker()));
  return { floats: new Float32Array(floats), near, far, plain };
}
