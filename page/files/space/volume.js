// The chunks around a place in space: which are in reach, nearest first, and requests for them.

import { Chunks } from "../chunks.js";
import { toNumber } from "../place.js";

/** A chunk is at least this many mean spacings wide. */
const WIDTH = 8;
/** Room for chunks in bytes: some of those left behind stay for the way back. */
const ROOM = 12e6;

/**
 * How chunks of space are requested; `z` follows x and y.
 * @type {import("../chunks.js").Kind}
 */
const SPACE = {
  requestOf: ([set], address) => ({ path: pathOf(set, address, "f32") }),
  columnsOf: () => ["z"],
};

/** The parameters that say what the points are. */
function parametersOf({ spacing, seed, profile }) {
  return `${profile === "blue" ? "" : `profile=${profile}&`}spacing=${spacing}&seed=${seed}`;
}

/** The path of a chunk. */
export function pathOf(set, { size, cx, cy, cz }, format) {
  return `/v1/space/chunks/${size}/${cx}/${cy}/${cz}?${parametersOf(set)}&format=${format}`;
}

/** The side of chunks for a spacing: a power of two, so that corners are exact. */
export function sizeFor(spacing) {
  return 2 ** Math.ceil(Math.log2(WIDTH * spacing));
}

/** The chunk that a place is in. */
export function chunkAt(at, size) {
  const [cx, cy, cz] = at.map((one) => Math.floor(toNumber(one) / size));
  return { size, cx, cy, cz };
}

/** The corner of a chunk as seen from a place. */
export function cornerOf(/** @type {import("../chunks.js").Address} */ { size, cx, cy, cz }, /** @type {import("../place.js").Place[]} */ at) {
  return [cx, cy, cz ?? 0].map((index, axis) => (index * size - at[axis].i) - at[axis].f);
}

/** The chunks within a distance of a place, nearest first. */
function chunksAround(at, size, reach) {
  const { cx, cy, cz } = chunkAt(at, size);
  const n = Math.ceil(reach / size);
  const found = [];
  for (let k = cz - n; k <= cz + n; k += 1) {
    for (let j = cy - n; j <= cy + n; j += 1) {
      for (let i = cx - n; i <= cx + n; i += 1) {
        const address = { size, cx: i, cy: j, cz: k };
        const away = Math.hypot(...cornerOf(address, at).map((low) => Math.max(0, low, -low - size)));
        if (away < reach) found.push({ ...address, away });
      }
    }
  }
  return found.sort((a, b) => a.away - b.away);
}

export class Volume {
  constructor(changed, failed) {
    this.chunks = new Chunks(changed, failed, { room: ROOM, kind: SPACE });
    this.around = null;
  }

  /** Requests the chunks around the place of a state, if it is another than before or far enough from it. */
  move({ at, reach, spacing, seed, profile }) {
    const [unit, size] = [Number(spacing), sizeFor(Number(spacing))];
    const what = [reach, spacing, seed, profile].join();
    const step = 0.1 * size;
    const from = this.around?.what === what ? this.around.at : null;
    if (from && Math.hypot(...at.map((one, axis) => (one.i - from[axis].i) + (one.f - from[axis].f))) < step) return;
    this.around = { what, at: [...at] };
    this.chunks.show([{ spacing, seed, profile }]);
    this.chunks.want(chunksAround(at, size, reach * unit + step), 1);
  }
}
