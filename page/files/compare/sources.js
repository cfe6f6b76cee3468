// Where the points of a panel come from: the server, chunk by chunk, or the worker, window by window.

import { ask } from "../api.js";
import { Chunks } from "../chunks.js";
import { chunkSize, chunksOf, cornerFrom } from "../grid.js";
import { decimalsFor, distance, formatPlace, moved, place } from "../place.js";
import { joined, setOf } from "../query.js";
import { LAYER } from "../state.js";
import { callsOf } from "../worker.js";
import { MEASURED, boxOf } from "./methods.js";

/** The part of the world that is held around a view, in views. */
const AHEAD = 2;
const make = callsOf("/page/compare/worker.js");

/** A window of a size around a place: its lower corner and its size. */
export function windowAround({ x, y }, width, height) {
  return { x: moved(x, -width / 2), y: moved(y, -height / 2), width, height };
}

/** Points that the worker makes. */
export class Made {
  constructor(method, changed, failed) {
    this.method = method;
    this.changed = changed;
    this.failed = failed;
    /** @type {any} */
    this.window = null;
    this.points = new Float64Array(0);
    /** Points in the region of a method that has one. */
    this.total = 0;
    /** The time of each, as far as it is known. */
    this.nanoseconds = NaN;
    this.version = 0;
    this.seed = NaN;
  }

  use({ seed }) {
    if (seed === this.seed) return;
    this.seed = seed;
    this.window = null;
  }

  /** Makes what a view needs, if it is not there. */
  cover(view) {
    this.view = view;
    if (!this.isBusy && !this.covers(view)) this.fetch();
  }

  covers({ x, y, width, height, unit }) {
    const { window } = this;
    if (!window) return false;
    const [w, h] = [width * unit, height * unit];
    const [dx, dy] = [distance(x, window.x) - w / 2, distance(y, window.y) - h / 2];
    return dx >= 0 && dy >= 0 && dx + w <= window.width && dy + h <= window.height && window.width < 4 * AHEAD * w;
  }

  async fetch() {
    this.isBusy = true;
    const { view, seed } = this;
    const window = windowAround(view, AHEAD * view.width * view.unit, AHEAD * view.height * view.unit);
    let made;
    try {
      made = await make({ method: this.method, seed, window });
    } catch (error) {
      return this.failed(error);
    } finally {
      this.isBusy = false;
    }
    if (seed === this.seed) {
      this.window = window;
      this.points = made.points;
      this.total = made.total ?? 0;
      this.nanoseconds = made.nanoseconds;
      this.version += 1;
    }
    this.changed();
  }

  /** Runs of points, with where each run's origin is from the middle of a view. */
  runs({ x, y }) {
    const { window, points } = this;
    if (!window) return [];
    return [{ points, count: points.length / 2, stride: 2, left: distance(window.x, x), low: distance(window.y, y) }];
  }

  /** The points of the measured square around a place, `null` if it is not all in the method's region. */
  async square(at) {
    const window = windowAround(at, MEASURED, MEASURED);
    const { points, isWhole } = await make({ method: this.method, seed: this.seed, window });
    return isWhole ? points : null;
  }

  /** What has to be made for a window: all of its region for a method that has one. */
  async alone(window) {
    const box = boxOf(this.method);
    const all = box ? { x: place(box[0]), y: place(box[1]), width: box[2] - box[0], height: box[3] - box[1] } : window;
    const { points } = await make({ method: this.method, seed: this.seed, window: all });
    return { points, count: points.length / 2, stride: 2, x: all.x, y: all.y };
  }
}

/** Points of the server. */
export class Asked {
  constructor(changed, failed) {
    this.chunks = new Chunks(() => {
      this.version += 1;
      changed();
    }, failed);
    this.version = 0;
    this.wanted = [];
    this.seed = "";
    this.total = 0;
    this.nanoseconds = NaN;
  }

  use({ seed, profile }) {
    this.layer = { ...LAYER, seed: String(seed), profile };
    this.seed = `${seed} ${profile}`;
    this.chunks.show([this.layer]);
    this.size = 0;
  }

  cover(view) {
    const wide = { ...view, width: 1.6 * view.width, height: 1.6 * view.height };
    this.wanted = this.chunks.want(chunksOf(wide, chunkSize(view, 1)), 1);
  }

  runs(view) {
    return this.wanted.map(({ data, count, stride, cx, cy, size }) => ({
      points: data, count, stride, left: cornerFrom(cx, size, view.x), low: cornerFrom(cy, size, view.y),
    }));
  }

  async answer({ x, y, width, height }) {
    const box = [x, y, moved(x, width), moved(y, height)].map((v) => formatPlace(v, decimalsFor(1e-9)));
    const answer = await ask(`/v1/points?bbox=${box.join(",")}&${joined([...setOf(this.layer), ["format", "f32"]])}`);
    return new Float32Array(await answer.arrayBuffer());
  }

  async square(at) {
    return Float64Array.from(await this.answer(windowAround(at, MEASURED, MEASURED)));
  }

  /** The points of a window, which are all that the server makes for it. */
  async alone(window) {
    const points = await this.answer(window);
    return { points, count: points.length / 2, stride: 2, x: window.x, y: window.y };
  }
}
