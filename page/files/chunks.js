// The chunks that are there, loading, or wanted: requested nearest first and a few at a time, aborted when
// they leave the view, kept while there is room.

import { Gone, Problem, ask, brokeOff, isAway, onPresence, piecesOf } from "./api.js";
import { firstOf } from "./bisect.js";
import { chunkRequest, columnsOf } from "./query.js";

/** Requests at a time: browsers open six connections, and one is for what is asked beside. */
const PARALLEL = 5;
/** Room for chunks in bytes, on machines with memory to spare and on others. */
const ROOM = (navigator.deviceMemory ?? 8) >= 4 ? 256e6 : 96e6;

/**
 * Where a chunk is: its side and the indices of its square, or cube; its distance, for the order of requests; and the share of
 * its points, where it has its own.
 * @typedef {{ size: number, cx: number, cy: number, cz?: number, away?: number, keep?: number }} Address
 */

/**
 * A chunk and the points of it that have arrived.
 * @typedef {object} Loaded
 * @property {string} key
 * @property {number} keep The share of its points.
 * @property {"waiting" | "loading" | "later" | "done"} state
 * @property {Float32Array<ArrayBuffer>} data `stride` numbers a point: x and y from the corner, then `columns`.
 * @property {number} stride
 * @property {string[]} columns
 * @property {number} count Points that have arrived.
 * @property {number} total Points that it has.
 * @property {any[]} layers
 * @property {number} tries
 * @property {number} [used]
 * @property {AbortController} [abort]
 * @property {(() => void) | null} [dropped] Called when its points are let go.
 * @property {any} [buffer] Where a painter keeps it.
 */
/** @typedef {Address & Loaded} Chunk */

/**
 * What chunks are of.
 * @typedef {object} Kind
 * @property {(layers: any[], address: any, keep: number) => { path: string, body?: string }} requestOf
 * @property {(layers: any[]) => string[]} columnsOf The columns that follow x and y.
 * @property {(layers: any[], address: any) => Promise<Float32Array<ArrayBuffer>>} [make] Makes the points where no server is asked.
 */

/** @type {Kind} */
const PLANE = { requestOf: chunkRequest, columnsOf };

/** The chunks of the layers that are shown. */
export class Chunks {
  /**
   * @param {() => void} changed Called whenever points arrive.
   * @param {(error: Error) => void} failed Called with what the server refuses.
   * @param {{ parallel?: number, room?: number, kind?: Kind }} options
   */
  constructor(changed, failed, { parallel = PARALLEL, room = ROOM, kind = PLANE } = {}) {
    this.changed = changed;
    this.failed = failed;
    this.parallel = parallel;
    this.room = room;
    this.kind = kind;
    /** Bytes that have come so far. */
    this.received = 0;
    /** @type {Map<string, Chunk>} */
    this.all = new Map();
    /** @type {Chunk[]} */
    this.wanted = [];
    this.running = 0;
    this.bytes = 0;
    this.clock = 0;
    /** @type {Error | null} */
    this.refused = null;
    /** The time until which a busy server is left alone, as `performance.now` counts. */
    this.restsUntil = 0;
    /** @type {any[]} */
    this.layers = [];
    /** @type {string[]} */
    this.columns = [];
    this.identity = "";
    this.unsubscribe = onPresence((gone) => gone || this.pump());
  }

  /** Says what the points are; requests for other points are aborted. */
  show(/** @type {any[]} */ layers) {
    const identity = this.identityOf(layers);
    if (identity === this.identity) return;
    this.identity = identity;
    this.layers = layers.map((layer) => ({ ...layer }));
    this.columns = this.kind.columnsOf(layers);
    this.refused = null;
    this.want([], 1);
  }

  /** Text that differs whenever the points or their columns do. */
  identityOf(/** @type {any[]} */ layers) {
    const { path, body } = this.kind.requestOf(layers, { size: 1, cx: 0, cy: 0, cz: 0 }, 1);
    return body ?? path;
  }

  /** Ends: what is being loaded is aborted. */
  stop() {
    this.unsubscribe();
    this.want([], 1);
  }

  /** Tries again what was refused, or put off. */
  retry() {
    this.refused = null;
    this.restsUntil = 0;
    for (const chunk of this.wanted) if (chunk.state === "later") chunk.state = "waiting";
    this.pump();
  }

  key(/** @type {Address} */ address, /** @type {number} */ keep) {
    const { size, cx, cy, cz } = address;
    return [this.identity, keep, size, cx, cy, cz].join(" ");
  }

  /**
   * Says which chunks are looked at; returns these, whatever they hold by now. An address may have its own `keep`.
   * @param {Address[]} addresses
   * @param {number} keep
   * @returns {Chunk[]}
   */
  want(addresses, keep) {
    this.clock += 1;
    this.wanted = addresses.map((address) => {
      const key = this.key(address, address.keep ?? keep);
      let chunk = this.all.get(key);
      if (!chunk) {
        chunk = {
          key, keep, ...address, state: "waiting", data: new Float32Array(0), count: 0, total: 0,
          stride: 2 + this.columns.length, columns: this.columns, layers: this.layers, tries: 0,
        };
        this.all.set(key, chunk);
      }
      chunk.away = address.away;
      chunk.used = this.clock;
      return chunk;
    });
    for (const chunk of this.all.values()) {
      if (chunk.used === this.clock) continue;
      if (chunk.state === "loading") chunk.abort?.abort();
      if (chunk.state !== "done") this.all.delete(chunk.key);
    }
    this.tidy();
    this.pump();
    return this.wanted;
  }

  /** The share of what is looked at that is there, 0 to 1. */
  get progress() {
    if (this.wanted.length === 0) return 1;
    const part = (/** @type {Chunk} */ chunk) => (chunk.state === "done" ? 1 : chunk.total > 0 ? chunk.count / chunk.total : 0);
    return this.wanted.reduce((sum, chunk) => sum + part(chunk), 0) / this.wanted.length;
  }

  /** What of what is looked at is there: points, chunks that are done, of those that are wanted; and bytes that have come so far. */
  get sums() {
    const { wanted, received } = this;
    return {
      points: wanted.reduce((sum, { count }) => sum + count, 0),
      done: wanted.filter(({ state }) => state === "done").length,
      wanted: wanted.length,
      received,
      isLater: wanted.some(({ state }) => state === "later"),
    };
  }

  /** Drops what was not looked at for longest, until the rest has room. */
  tidy() {
    if (this.bytes <= this.room) return;
    const old = [...this.all.values()].filter((chunk) => chunk.state === "done" && (chunk.used ?? 0) < this.clock);
    for (const chunk of old.sort((a, b) => (a.used ?? 0) - (b.used ?? 0))) {
      if (this.bytes <= this.room) break;
      this.bytes -= chunk.data.byteLength;
      this.all.delete(chunk.key);
      chunk.dropped?.();
    }
  }

  pump() {
    while (this.running < this.parallel && !this.refused && (this.kind.make || !isAway()) && performance.now() >= this.restsUntil) {
      const next = this.wanted.find((chunk) => chunk.state === "waiting");
      if (!next) return;
      this.load(next);
    }
  }

  /** @param {Chunk} chunk */
  async load(chunk) {
    this.running += 1;
    chunk.state = "loading";
    chunk.abort = new AbortController();
    try {
      if (this.kind.make) {
        chunk.data = await this.kind.make(chunk.layers, chunk);
        chunk.abort.signal.throwIfAborted();
        chunk.count = chunk.total = chunk.data.length / chunk.stride;
      } else {
        const { path, body } = this.kind.requestOf(chunk.layers, chunk, chunk.keep);
        await this.receive(chunk, await ask(path, { body, signal: chunk.abort.signal }));
      }
      chunk.state = "done";
      this.bytes += chunk.data.byteLength;
    } catch (error) {
      this.lost(chunk, /** @type {Error} */ (error));
    }
    this.running -= 1;
    this.changed();
    this.pump();
  }

  /** Takes points in as they arrive. */
  async receive(/** @type {Chunk} */ chunk, /** @type {Response} */ answer) {
    chunk.total = Number(answer.headers.get("strew-count"));
    chunk.count = 0;
    const record = 4 * chunk.stride;
    chunk.data = new Float32Array(chunk.total * chunk.stride);
    const bytes = new Uint8Array(chunk.data.buffer);
    let filled = 0;
    for await (const piece of piecesOf(answer)) {
      bytes.set(piece.subarray(0, bytes.length - filled), filled);
      filled += piece.length;
      this.received += piece.length;
      chunk.count = Math.min(chunk.total, Math.floor(filled / record));
      this.changed();
    }
    if (filled !== bytes.length) throw brokeOff();
  }

  /** A chunk that did not come is requested again, unless it was aborted or refused for good. */
  lost(/** @type {Chunk} */ chunk, /** @type {Error} */ error) {
    chunk.state = "waiting";
    chunk.count = 0;
    chunk.dropped?.();
    if (error.name === "AbortError") {
      if (!this.wanted.includes(chunk)) this.all.delete(chunk.key);
    } else if (error instanceof Gone) {
      // It is requested again when the server is back.
    } else if (error instanceof Problem && error.isPassing) {
      // All others wait as well: a server that is busy is busy for them, too.
      chunk.state = "later";
      chunk.tries += 1;
      const wait = Math.max(error.retryAfter * 1000, Math.min(10_000, 200 * 2 ** chunk.tries));
      this.restsUntil = Math.max(this.restsUntil, performance.now() + wait);
      setTimeout(() => {
        if (chunk.state === "later") chunk.state = "waiting";
        this.pump();
      }, wait + 20);
    } else if (!this.refused && chunk.layers === this.layers) {
      this.refused = error;
      this.failed(error);
    }
  }
}

/** The runs of a chunk's points by layer, as far as they have arrived: `[{ layer, first, count }]`. */
export function runsOf(/** @type {Chunk} */ chunk) {
  if (chunk.columns[0] !== "layer") return [{ layer: 0, first: 0, count: chunk.count }];
  // Points come one layer after another.
  const { data, stride, count } = chunk;
  const firstIn = (/** @type {number} */ layer) => firstOf(count, (k) => data[k * stride + 2] >= layer);
  return chunk.layers.map((_, layer) => {
    const first = firstIn(layer);
    return { layer, first, count: firstIn(layer + 1) - first };
  });
}
