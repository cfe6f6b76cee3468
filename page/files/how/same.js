// Points of one block, that is of nearly the same index, and their surroundings laid over each other: they agree.

import { Pattern, blockOf } from "./pattern.js";
import { colorOf, indexOf } from "./indices.js";
import { disk, dotOf, pair } from "./pen.js";
import { Figure } from "./stage.js";

/** Half the sides of the windows: of the pattern that is shown, of the surroundings, and of where alike points are looked for. */
export const REACH = 16;
const AROUND = 11;
const FAR = 90;
/** How far points of one color agree. */
const RADIUS = 6;
/** The most surroundings that are laid over each other, and the seconds for each. */
const MOST = 40;
const EACH = 0.42;

/** The point near the middle that has most points of its block in the window. */
export function sociable(pattern, points, starts) {
  const counts = new Map();
  for (const point of points) {
    const block = blockOf(pattern, starts, point);
    counts.set(block, (counts.get(block) ?? 0) + 1);
  }
  const middle = points.filter(([x, y]) => Math.max(Math.abs(x), Math.abs(y)) < REACH / 2);
  const fellows = (point) => counts.get(blockOf(pattern, starts, point));
  return middle.reduce((best, point) => (fellows(point) > fellows(best) ? point : best));
}

export class Same extends Figure {
  /** @type {number[][]} */
  alike;
  laid = 0;
  /** @type {{ key: string, counts: Map<string, number> } | undefined} */
  counted;

  constructor() {
    super();
    this.pattern = new Pattern();
    this.points = this.pattern.points(REACH);
    this.starts = this.pattern.starts(RADIUS);
    this.isSame = true;
    this.pick(sociable(this.pattern, this.points, this.starts));
    this.restart();
  }

  /** Looks at a point: finds those that are laid over it. */
  pick(point) {
    this.point = point;
    const block = blockOf(this.pattern, this.starts, point);
    const all = this.pattern.points(FAR);
    const isAlike = this.isSame ? (other) => blockOf(this.pattern, this.starts, other) === block : (_, i) => i % 61 === 7;
    const others = all.filter((other, i) => String(other) !== String(point) && isAlike(other, i));
    const far = (/** @type {number[]} */ [x, y]) => (x - point[0]) ** 2 + (y - point[1]) ** 2;
    this.alike = [point, ...others.sort((a, b) => far(a) - far(b)).slice(0, MOST - 1)];
  }

  choose(kind) {
    this.isSame = kind === "same";
    this.pick(this.point);
    this.restart();
  }

  restart() {
    Object.assign(this, { laid: 1, seconds: 0 });
  }

  step(seconds) {
    this.seconds += seconds;
    // The first ones are laid one by one, the others ever faster.
    this.laid = Math.min(this.alike.length, 1 + Math.floor((this.seconds / EACH) ** 1.4 / 2));
    this.tell();
    return this.laid < this.alike.length;
  }

  finish() {
    this.laid = this.alike.length;
    this.tell();
  }

  look(point) {
    if (String(point) !== String(this.point)) this.pick(point);
    this.laid = this.alike.length;
    this.tell();
  }

  /** How many of the surroundings so far have a point at each offset. */
  layers() {
    const key = `${this.isSame} ${this.point} ${this.laid}`;
    if (this.counted?.key === key) return this.counted.counts;
    const counts = new Map();
    for (const [x, y] of this.alike.slice(0, this.laid)) {
      for (let j = -AROUND; j <= AROUND; j += 1) {
        for (let i = -AROUND; i <= AROUND; i += 1) {
          if (this.pattern.has(x + i, y + j)) counts.set(`${i}:${j}`, (counts.get(`${i}:${j}`) ?? 0) + 1);
        }
      }
    }
    this.counted = { key, counts };
    return counts;
  }

  tell() {
    const kind = this.isSame ? "of its color" : "of any color";
    const said = this.isSame ? "Inside the frame they agree, dot on dot." : "They agree nowhere.";
    this.stage?.say(`${this.laid} points ${kind}, laid over each other. ${said}`);
  }

  draw(context, width, height, colors) {
    const edge = REACH + 0.7;
    const around = AROUND + 0.7;
    this.panels = pair(width, height, [[-edge, -edge], [edge, edge]], [[-around, -around], [around, around]]);
    const [left, right] = this.panels;
    const laid = this.alike.slice(0, this.laid);
    left.clipped(context, () => {
      for (const point of this.points) disk(context, left.to(point), dotOf(left.scale), colorOf(this.pattern, indexOf(this.pattern, point)));
      for (const point of laid) disk(context, left.to(point), left.scale * 0.85, colors.block, 2);
    });
    left.outline(context, this.point.map((v) => v - RADIUS - 0.5), [2 * RADIUS + 1, 2 * RADIUS + 1], colors.block, 1.5);
    left.frame(context, colors.line);
    const counts = this.layers();
    for (const [offset, count] of counts) {
      const [i, j] = offset.split(":").map(Number);
      context.globalAlpha = count === this.laid ? 1 : Math.max(0.1, 0.75 * (count / this.laid));
      disk(context, right.to([i, j]), dotOf(right.scale) * (count === this.laid ? 1 : 0.8), count === this.laid ? colors.ink : colors.soft);
    }
    context.globalAlpha = 1;
    disk(context, right.to([0, 0]), dotOf(right.scale), colorOf(this.pattern, indexOf(this.pattern, this.point)));
    disk(context, right.to([0, 0]), right.scale * 0.75, colors.block, 2);
    right.outline(context, [-RADIUS - 0.5, -RADIUS - 0.5], [2 * RADIUS + 1, 2 * RADIUS + 1], colors.block, 1.5);
    right.frame(context, colors.line);
    this.stage.name(`Left the pattern, points in the colors of their indices; right the surroundings of ${this.laid} points laid over each other. Arrow keys choose a point.`);
  }
}
