// One period of a point set, and the picture of its copies.

import { ask, askJson } from "../api.js";
import { spectrumPicture } from "../charts.js";
import { Sheet } from "../compare/sheet.js";
import { counted } from "../dom.js";
import { measure } from "../measure.js";
import { distance } from "../place.js";
import { joined } from "../query.js";

/** The parameters that say which period. */
export function pairsOf({ profile, map, points, share, seed }) {
  const pairs = [["periodic", String(points)], ["profile", profile], ["map", map], ["spacing", "1"], ["seed", seed]];
  return share < 1 ? [...pairs, ["keep", String(share)]] : pairs;
}

export class Period {
  constructor(canvas) {
    this.sheet = new Sheet(canvas);
    this.version = 0;
    this.points = new Float32Array(0);
    this.side = 1;
    /** @type {any} */
    this.measured = null;
  }

  /** Whether there is something to show. */
  get isThere() {
    return this.points.length > 0;
  }

  clear() {
    this.take({ points: new Float32Array(0), side: 1, measured: null });
  }

  /** The choice as the server resolves it: `{ words, … }`, for `take`. */
  async load(state) {
    const set = joined(pairsOf(state));
    const [{ count, query }, answer] = await Promise.all([askJson(`/v1/count?${set}`), ask(`/v1/points?${set}&format=f32`)]);
    const points = new Float32Array(await answer.arrayBuffer());
    const { side = 1 } = query.period ?? {};
    const { least_distance: least = 0 } = query;
    const measured = await measure(Float64Array.from(points), side);
    const apart = least >= 0.005 ? `, no two closer than ${least.toFixed(2)}, even across the seam` : "";
    return { points, side, measured, words: `${counted(Number(count))} on a square of ${side} × ${side} mean spacings${apart}.` };
  }

  take({ points, side, measured }) {
    this.points = points;
    this.side = side;
    this.measured = measured;
    this.version += 1;
  }

  renew() {
    this.sheet.renew();
  }

  draw(view) {
    this.sheet.draw(view, this);
  }

  /** The copies in and around a view, as the sheet takes them: where each one's corner is from the middle. */
  runs(view) {
    const { points, side } = this;
    if (!this.isThere) return [];
    const half = [view.width, view.height].map((v) => 0.85 * v * view.unit);
    const from = [view.x, view.y].map((at) => distance({ i: 0, f: 0 }, at));
    const corners = from.map((at, axis) => {
      const first = Math.floor((-half[axis] - at) / side);
      const last = Math.floor((half[axis] - at) / side);
      return Array.from({ length: last - first + 1 }, (_, k) => at + (first + k) * side);
    });
    return corners[1].flatMap((low) => corners[0].map((left) => ({ points, count: points.length / 2, stride: 2, left, low })));
  }

  /** Draws the spectrum; returns what it is. */
  picture(canvas) {
    spectrumPicture(canvas, this.measured.image, this.measured.cells);
    return "Its spectrum up to ν = 2.5, with frequency 0 in the middle. An empty middle means even spreading.";
  }
}
