// The AA pattern of any α in the page itself: the arithmetic of the server, in integers of 2⁻⁶⁴ turns.

const HALF = 1n << 63n;

/** The α that are known by name, with what the buttons say. */
export const KNOWN = [
  ["(5-sqrt(3))/2", "(5 − √3)/2"],
  ["sqrt(3)", "√3"],
  ["(1+sqrt(5))/2", "golden ratio"],
  ["13/8", "13/8"],
];

/** The square root of an integer, rounded down. */
function root(n) {
  let x = 1n << BigInt(Math.ceil(n.toString(2).length / 2));
  for (;;) {
    const next = (x + n / x) >> 1n;
    if (next >= x) return x;
    x = next;
  }
}

/** α · 2⁶³, rounded to the nearest integer: a decimal, a fraction, or one of the known irrationals. */
function halfTurns(text) {
  const clean = text.replace(/\s/g, "");
  // √n · 2⁶⁴, rounded down: one bit more than is kept.
  const fine = (n) => root(n << 128n);
  if (clean === "sqrt(3)") return (fine(3n) + 1n) >> 1n;
  if (clean === "(5-sqrt(3))/2") return ((5n << 64n) - fine(3n) + 1n) >> 2n;
  if (clean === "(1+sqrt(5))/2") return ((1n << 64n) + fine(5n) + 2n) >> 2n;
  const fraction = /^(\d{1,15})\/(\d{1,15})$/.exec(clean);
  const decimal = /^(\d?)\.(\d{1,17})$/.exec(clean);
  const [, above, below] = fraction ?? (decimal ? [null, decimal[1] + decimal[2], `1${"0".repeat(decimal[2].length)}`] : []);
  if (!above || !below) return null;
  const [p, q] = [BigInt(above), BigInt(below)];
  if (q === 0n || p <= q || p >= 2n * q) return null;
  return (2n * p * HALF + q) / (2n * q);
}

/** A length of index space as a number of turns. */
export function turns(value) {
  return Number(value) / 2 ** 64;
}

/** A difference of turns, which has a sign: from −½ to ½. */
export function signedTurns(value) {
  return turns(BigInt.asIntN(64, value));
}

export class Pattern {
  /** The pattern of an α, or nothing if it is no number between 1 and 2. */
  static of(text) {
    const half = halfTurns(text);
    return half === null ? null : new Pattern(text, half);
  }

  constructor(text, half) {
    this.text = text;
    this.half = half;
    /** The side of the set region: (α − 1)/2 turns. */
    this.side = half - HALF;
    this.t = turns(this.side);
    this.alpha = Number(half) / 2 ** 63;
    this.known = new Map();
    this.windows = new Map();
  }

  /** {(αv + other)/2}, by the parity of the other coordinate. */
  along(v, parity) {
    const key = v * 2 + parity;
    let index = this.known.get(key);
    if (index === undefined) {
      index = BigInt.asUintN(64, this.half * BigInt(v) + (parity ? HALF : 0n));
      this.known.set(key, index);
    }
    return index;
  }

  /** The index of a grid point, as two integers. */
  index(x, y) {
    return [this.along(x, y & 1), this.along(y, x & 1)];
  }

  has(x, y) {
    return this.along(x, y & 1) < this.side && this.along(y, x & 1) < this.side;
  }

  /** The points of a square window around the origin, row by row. */
  points(reach) {
    const known = this.windows.get(reach);
    if (known) return known;
    const found = [];
    for (let y = -reach; y <= reach; y += 1) {
      for (let x = -reach; x <= reach; x += 1) if (this.has(x, y)) found.push([x, y]);
    }
    this.windows.set(reach, found);
    return found;
  }

  /** Where the intervals of the map of half-width R begin, ascending from 0. */
  starts(radius) {
    const all = new Set([0n]);
    for (let k = -radius; k <= radius; k += 1) {
      for (const parity of [0, 1]) {
        for (const edge of [0n, this.side]) {
          const at = BigInt.asUintN(64, edge - this.along(k, parity));
          if (at > 0n && at < this.side) all.add(at);
        }
      }
    }
    return [...all].sort((a, b) => (a < b ? -1 : 1));
  }

  /** The part of the set region that offsets leave: image and margin along both axes, and the density. */
  arrangement(offsets) {
    const image = [[0n, 0n], [0n, 0n]];
    for (const [x, y] of offsets) {
      this.index(x, y).forEach((index, axis) => {
        const shift = BigInt.asIntN(64, index);
        if (shift < image[axis][0]) image[axis][0] = shift;
        if (shift > image[axis][1]) image[axis][1] = shift;
      });
    }
    const margin = image.map(([low, high]) => [-low, this.side - high]);
    const exists = margin.every(([from, to]) => from < to);
    const sides = margin.map(([from, to]) => turns(to - from));
    return { image, margin, exists, density: exists ? sides[0] * sides[1] : 0 };
  }
}

/** The interval that holds an index. */
export function intervalOf(starts, index) {
  let [low, high] = [0, starts.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (starts[middle] <= index) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** The most points of a cluster that is recognized. */
export const MOST = 24;

/**
 * The clusters of points at most a distance apart: for each point, by `x:y`, the name of its cluster's shape up
 * to the symmetries of the square, or nothing for clusters of more than `MOST` points or at the window's edge.
 */
export function clustersOf(points, distance, reach) {
  const open = new Map(points.map((point) => [`${point[0]}:${point[1]}`, point]));
  const limit = distance * distance * (1 + 1e-12);
  const across = Math.floor(distance);
  const shapes = new Map();
  for (const first of points) {
    if (!open.delete(`${first[0]}:${first[1]}`)) continue;
    const members = [first];
    for (let next = 0; next < members.length; next += 1) {
      const [x, y] = members[next];
      for (let j = -across; j <= across; j += 1) {
        for (let i = -across; i <= across; i += 1) {
          const key = `${x + i}:${y + j}`;
          if (i * i + j * j > limit || !open.has(key)) continue;
          members.push(open.get(key));
          open.delete(key);
        }
      }
    }
    const isCut = members.some(([x, y]) => Math.max(Math.abs(x), Math.abs(y)) + across > reach);
    const name = isCut || members.length > MOST ? null : upright(members);
    for (const [x, y] of members) shapes.set(`${x}:${y}`, name);
  }
  return shapes;
}

/** The least of the eight images of a shape, moved to the origin, as text. */
function upright(members) {
  const images = [];
  for (let bits = 0; bits < 8; bits += 1) {
    const turned = members.map(([x, y]) => {
      const [a, b] = bits & 4 ? [y, x] : [x, y];
      return [bits & 1 ? -a : a, bits & 2 ? -b : b];
    });
    turned.sort((p, q) => p[1] - q[1] || p[0] - q[0]);
    images.push(turned.map(([x, y]) => `${x - turned[0][0]},${y - turned[0][1]}`).join(" "));
  }
  return `${String(members.length).padStart(2, "0")} ${images.sort()[0]}`;
}
