// The gate cut into blocks by how far points look, and the points of one block in the pattern.

import { Pattern, blockOf, intervalOf, nearest, turns } from "./pattern.js";
import { colorOf, indexOf } from "./indices.js";
import { disk, dotOf, line, pair } from "./pen.js";
import { REACH, sociable } from "./same.js";
import { Figure } from "./stage.js";

/** How far points look at first, at last, and the seconds in between. */
const FIRST = 1;
const LAST = 20;
const GROWS = 9;

export class Blocks extends Figure {
  /** @type {{ set: (value: number) => void } | undefined} */
  slider;
  /** @type {bigint[]} */
  starts;
  radius = 0;

  constructor() {
    super();
    this.pattern = new Pattern();
    this.points = this.pattern.points(REACH);
    this.point = sociable(this.pattern, this.points, this.pattern.starts(7));
    this.restart();
  }

  restart() {
    this.seconds = 0;
    this.see(FIRST);
  }

  see(radius) {
    this.radius = radius;
    this.starts = this.pattern.starts(radius);
    this.tell();
  }

  step(seconds) {
    this.seconds += seconds;
    const radius = Math.min(LAST, FIRST + Math.floor(((LAST - FIRST + 1) * this.seconds) / GROWS));
    if (radius !== this.radius) {
      this.see(radius);
      this.slider?.set(radius);
    }
    return this.seconds < GROWS;
  }

  finish() {
    this.see(LAST);
    this.slider?.set(LAST);
  }

  touched(at) {
    const [gate, plane] = this.panels;
    if (plane.holds(at)) this.look(nearest(this.points, plane.from(at)));
    else if (gate.holds(at)) this.look(this.near(gate.from(at)));
  }

  /** The point whose index is nearest to a place in the gate. */
  near(/** @type {number[]} */ [u, v]) {
    const far = (point) => indexOf(this.pattern, point).reduce((sum, w, i) => sum + (w - [u, v][i]) ** 2, 0);
    return this.points.reduce((best, point) => (far(point) < far(best) ? point : best));
  }

  tell() {
    const n = this.starts.length;
    const block = blockOf(this.pattern, this.starts, this.point);
    const same = this.points.filter((point) => blockOf(this.pattern, this.starts, point) === block).length;
    const kinds = (n * n).toLocaleString("en");
    const seen = same === 1 ? "The chosen point is alone in its block here" : `${same} points in view are in the chosen block`;
    this.stage?.say(`R = ${this.radius}: ${n} × ${n} = ${kinds} blocks, so ${kinds} kinds of surroundings. ${seen}.`);
  }

  draw(context, width, height, colors) {
    const { pattern, starts } = this;
    const { t } = pattern;
    const edge = REACH + 0.7;
    this.panels = pair(width, height, [[0, 0], [t, t]], [[-edge, -edge], [edge, edge]]);
    const [gate, plane] = this.panels;
    gate.fill(context, [0, 0], [t, t], colors.gate, 0.12);
    const bounds = this.pattern.index(this.point[0], this.point[1]).map((index) => intervalOf(starts, index));
    const low = bounds.map((i) => turns(starts[i]));
    const high = bounds.map((i) => turns(starts[i + 1] ?? pattern.side));
    const size = high.map((v, axis) => v - low[axis]);
    for (const start of starts.slice(1).map(turns)) {
      line(context, gate.to([start, 0]), gate.to([start, t]), colors.soft, 0.7);
      line(context, gate.to([0, start]), gate.to([t, start]), colors.soft, 0.7);
    }
    gate.fill(context, low, size, colors.block);
    const block = bounds.join();
    for (const point of this.points) {
      const index = indexOf(pattern, point);
      const color = colorOf(pattern, index);
      disk(context, gate.to(index), Math.max(1.8, gate.width / 130), color);
      disk(context, plane.to(point), dotOf(plane.scale), color);
      if (blockOf(pattern, starts, point) === block) disk(context, plane.to(point), plane.scale * 0.85, colors.block, 2);
    }
    gate.outline(context, low, size, colors.block, 2.5);
    disk(context, gate.to(indexOf(pattern, this.point)), 5, colors.ink, 1.5);
    gate.frame(context, colors.gate, 2);
    plane.clipped(context, () => {
      const reach = this.radius + 0.5;
      plane.outline(context, this.point.map((v) => v - reach), [2 * reach, 2 * reach], colors.block, 1.5);
      disk(context, plane.to(this.point), plane.scale * 1.1, colors.ink, 1.5);
    });
    plane.frame(context, colors.line);
    this.stage.name(`Left the gate, cut into ${starts.length} by ${starts.length} blocks, one of them chosen; right the pattern, the points of that block ringed. Arrow keys choose a point.`);
  }
}
