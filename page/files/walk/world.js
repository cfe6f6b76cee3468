// The surroundings of the walker: chunks of two sets, of trees and of grass, each in leaves; the ground below them; and what
// of it is ready to be drawn.

import { Chunks } from "../chunks.js";
import { cornerFrom, indexOf } from "../grid.js";
import { parsePlace, moved, distance } from "../place.js";
import { LAYER } from "../state.js";
import { projected } from "./camera.js";
import { INSTANCE_FLOATS, VARIANTS, groundOf, standing } from "./ground.js";
import { KINDS } from "./shapes.js";

// A square twice as wide holds a quarter of the points, those of the lowest rank: every square has about as many, and a point
// that is drawn far away is one of those that are drawn nearby.

/** The places of leaves follow the walker in steps of this many units, not with every frame. */
const STEP = 4;

/**
 * The squares around a place, nearest first: `{ level, size, cx, cy, keep, away, from }`, where `from` is where the
 * corner is, seen from the place.
 *
 * `base` is the side of the smallest, `near` how far all points are drawn, `reach` how far any are.
 */
function leavesAround(at, { base, near, reach }) {
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
function nameOf({ level, cx, cy }) {
  return `${level}/${cx}/${cy}`;
}

/**
 * What is drawn for a leaf: itself if `ready` has it, else a larger square around it, of which only the leaf's part is
 * drawn, else the parts of it that are there. Each comes with the leaf's own square as its `clip`.
 */
function standIns(leaf, ready, deepest = 2) {
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

/** The time for making leaves ready in a frame, in milliseconds, and as a share of what the last frame took. */
const BUILDING = 8;
const SHARE = 0.3;
/** Nets of the ground that are kept beside those in use. */
const NETS = 160;
/** Room for the chunks of each set in bytes. */
const ROOM = 40e6;

const SETS = [
  { amount: "2", variant: true, range: "0.75,1.3", base: 64, parallel: 4 },
  { amount: "0.7", variant: false, range: "0.6,1.3", base: 16, parallel: 2 },
];

/** @typedef {import("../place.js").Place} Place */

/** The layers that the sets are for a seed, as the plane shows them and requests name them. */
export function layersOf(seed) {
  const variants = Object.entries(VARIANTS).map(([name, weight]) => `${name}:${weight}`).join(",");
  return SETS.map(({ amount, variant, range }) => ({
    ...LAYER, amount, seed, angle: true, scale: true, range, variant, rank: true, ...(variant ? { variants } : {}),
  }));
}

export class World {
  constructor(scene, seed, failed) {
    this.scene = scene;
    this.seed = seed;
    /** @type {any} */
    this.quality = null;
    /** When leaves are made ready no longer, in this frame. */
    this.until = 0;
    /** @type {any[]} */
    this.grounds = [];
    /** @type {any[]} */
    this.things = [];
    this.nets = new Map();
    this.layers = layersOf(seed);
    this.sets = SETS.map((set, i) => {
      const changed = () => (this.isStale = true);
      const chunks = new Chunks(changed, failed, { parallel: set.parallel, room: ROOM });
      chunks.show([this.layers[i]]);
      return { ...set, chunks, near: 0, leaves: /** @type {any[]} */ ([]), built: new Map() };
    });
    /** @type {any} */
    this.around = null;
    this.isStale = true;
    /** How often it was said what is to be drawn. */
    this.composed = 0;
  }

  /** Says where the walker is, in which direction leaves come first, and how much is drawn. */
  move(at, ahead, quality) {
    const isFar = !this.around || Math.hypot(distance(at.x, this.around.x), distance(at.y, this.around.y)) > STEP;
    if (isFar || quality !== this.quality) {
      if (quality.cells !== this.quality?.cells) this.forget();
      this.around = { x: at.x, y: at.y };
      this.quality = quality;
      this.sets.forEach((set, i) => this.want(set, quality.sets[i], ahead));
      this.isStale = true;
    }
  }

  want(set, { near, reach }, ahead) {
    set.near = near;
    set.leaves = reach > 0 ? leavesAround(this.around, { base: set.base, near, reach }) : [];
    // Leaves behind the walker may come later.
    const turned = ({ from, size, away }) => {
      const forth = (from[0] + size / 2) * ahead[0] + (from[1] + size / 2) * ahead[1];
      return forth > -size ? away : 2 * away + size;
    };
    const order = [...set.leaves].sort((a, b) => turned(a) - turned(b));
    set.chunks.want(order.map(({ size, cx, cy, keep, away }) => ({ size, cx, cy, keep, away })), 1);
  }

  /** The ground of a leaf of trees, made if it is not there. */
  net(leaf) {
    const name = nameOf(leaf);
    let net = this.nets.get(name);
    if (!net) {
      const ground = groundOf(leaf, this.quality.cells);
      net = { ground, buffer: this.scene.buffer(ground.floats) };
    }
    // The net used last is the last in the map.
    this.nets.delete(name);
    this.nets.set(name, net);
    return net;
  }

  /** The chunk of a leaf made ready, if it has arrived; a few in a frame. */
  thing(set, leaf) {
    const name = nameOf(leaf);
    const known = set.built.get(name);
    if (known) return known;
    const chunk = set.chunks.all.get(set.chunks.key(leaf, leaf.keep));
    if (chunk?.state !== "done") return null;
    if (performance.now() > this.until) {
      this.isStale = true;
      return null;
    }
    const cells = Math.max(2, (this.quality.cells * leaf.size) / 64);
    const ground = set === this.sets[0] ? this.net(leaf).ground : groundOf(leaf, cells);
    const { floats, runs } = standing(chunk, ground);
    const thing = { floats, runs, count: chunk.count, buffer: this.scene.buffer(floats) };
    set.built.set(name, thing);
    chunk.dropped = () => this.drop(set, name);
    return thing;
  }

  drop(set, name) {
    const thing = set.built.get(name);
    if (thing) this.scene.free(thing.buffer);
    set.built.delete(name);
  }

  forget() {
    for (const set of this.sets) for (const name of [...set.built.keys()]) this.drop(set, name);
    for (const { buffer } of this.nets.values()) this.scene.free(buffer);
    this.nets.clear();
  }

  /** Ends: nothing more is requested or kept. */
  stop() {
    for (const { chunks } of this.sets) chunks.stop();
    this.forget();
  }

  /**
   * The things to draw from a place: `{ grounds, things }`, with leaves placed as seen from there. `took` is the time of
   * the last frame.
   */
  look(at, took) {
    if (this.isStale) this.compose(took);
    const by = [distance(this.around.x, at.x), distance(this.around.y, at.y)];
    const seen = ({ leaf, clip, ...rest }) => {
      const from = [leaf.from[0] + by[0], leaf.from[1] + by[1]];
      return { ...rest, leaf: { ...leaf, from }, clip: clip && [clip[0] + by[0], clip[1] + by[1], clip[2]] };
    };
    return { grounds: this.grounds.map(seen), things: this.things.map(seen) };
  }

  compose(took) {
    // Leaves that cannot be made ready in this frame come in the next ones.
    this.isStale = false;
    this.composed += 1;
    this.until = performance.now() + Math.max(BUILDING, SHARE * took);
    this.grounds = this.sets[0].leaves.flatMap((leaf) => {
      if (this.nets.has(nameOf(leaf)) || performance.now() < this.until) return [{ leaf, ...this.net(leaf) }];
      this.isStale = true;
      return [];
    });
    this.things = this.sets.flatMap((set) => set.leaves.flatMap((leaf) => (
      standIns(leaf, (one) => this.thing(set, one)).map(({ leaf: shown, clip }) => {
        const away = Math.max(0, leaf.away - 2 * STEP);
        return { ...this.thing(set, shown), leaf: { ...shown, away }, clip, near: set.near, set };
      })
    )));
    for (const [name, { buffer }] of this.nets) {
      if (this.nets.size <= this.sets[0].leaves.length + NETS) break;
      this.scene.free(buffer);
      this.nets.delete(name);
    }
  }

  /** Whether all that is wanted is there and ready. */
  get isReady() {
    return !this.isStale && this.sets.every((set) => set.leaves.every((leaf) => set.built.has(nameOf(leaf))));
  }

  /** Numbers for the line below: points that are loaded, chunks, bytes received so far. */
  get sums() {
    const [trees, grass] = this.sets.map(({ chunks }) => chunks.sums);
    const both = (/** @type {"points" | "done" | "wanted" | "received"} */ name) => trees[name] + grass[name];
    return { loaded: both("points"), chunks: both("done"), wanted: both("wanted"), received: both("received") };
  }

  /** The height of the ground at a place. */
  heightAt(at) {
    const size = 64;
    const [cx, cy] = [Math.floor(at.x.i / size), Math.floor(at.y.i / size)];
    const net = this.net({ level: 0, size, cx, cy });
    return net.ground.height(at.x.i - cx * size + at.x.f, at.y.i - cy * size + at.y.f);
  }

  /**
   * The point whose picture is at a place of the window (from −1 to 1), or nearest to it within `miss`: its kind, its
   * coordinates and its size. `null` if there is none.
   */
  pick(/** @type {any} */ look, /** @type {number[]} */ [x, y], /** @type {number} */ aspect, /** @type {number} */ miss) {
    /** @type {any} */
    let best = null;
    for (const { leaf, clip, runs, floats, set } of look.things) {
      if (set !== this.sets[0] || clip || leaf.away > 2 * set.near) continue;
      for (const { kind, first, ranks } of runs) {
        for (let i = first; i < first + ranks.length; i += 1) {
          const at = floats.subarray(i * INSTANCE_FLOATS, i * INSTANCE_FLOATS + 4);
          const foot = [leaf.from[0] + at[0], leaf.from[1] + at[1], at[2] - look.height];
          const middle = projected(look.camera, [foot[0], foot[1], foot[2] + at[3] / 2]);
          if (!middle) continue;
          const half = at[3] / 2 / (middle.depth * look.camera.tall);
          const [dx, dy] = [Math.abs(middle.x - x) * aspect, Math.abs(middle.y - y)];
          const off = Math.hypot(Math.max(0, dx - 0.45 * half), Math.max(0, dy - half));
          if (off > miss) continue;
          // What is in front hides what is behind it.
          const cost = middle.depth * (1 + (20 * off) / miss);
          if (!best || cost < best.cost) best = { cost, kind: KINDS[kind], leaf, offset: [at[0], at[1]], size: at[3], foot };
        }
      }
    }
    if (!best) return null;
    const [px, py] = [best.leaf.cx, best.leaf.cy].map((index, axis) => (
      moved(/** @type {Place} */ (parsePlace(String(BigInt(index) * BigInt(best.leaf.size)))), best.offset[axis])
    ));
    return { ...best, x: px, y: py };
  }
}
