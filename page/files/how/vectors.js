// From the pattern to the points: a point and its twin far away, in the same block, on their way along the same vector.

import { Pattern, blockOf, nearest } from "./pattern.js";
import { colorOf, indexOf } from "./indices.js";
import { arrow, disk, dotOf, eased, lines, pair } from "./pen.js";
import { Figure } from "./stage.js";

/** Half the sides of the windows and of what is requested, in grid units; and of where twins are looked for. */
const REACH = 11;
const AROUND = REACH + 8;
const FAR = 260;
/** How far points of one block agree: the map of the server's table. */
const RADIUS = 100;
/** The seconds of a way there, of a stay, and how often it goes. */
const WAY = 2.4;
const STAY = 1;
const ROUNDS = 2;

const signed = (v) => v.toFixed(2).replace("-", "−");
const whole = (v) => String(v).replace("-", "−");

export class Vectors extends Figure {
  /** @type {{ set: (value: number) => void } | undefined} */
  slider;
  /** @type {Map<string, number[]>} */
  twins;
  share = 0;

  constructor() {
    super();
    this.pattern = new Pattern();
    /** The vectors by the address of the point. */
    this.vectors = new Map();
    this.pair = [[0, 0], [0, 0]];
    this.restart();
  }

  /** Finds the points in view that have a twin, and shows one of them. */
  load() {
    const starts = this.pattern.starts(RADIUS);
    const near = this.pattern.points(REACH - 2);
    const isNear = new Set(near.map(String));
    const blocks = new Map(near.map((point) => [blockOf(this.pattern, starts, point), point]));
    this.twins = new Map();
    for (const point of this.pattern.points(FAR)) {
      const fellow = blocks.get(blockOf(this.pattern, starts, point));
      if (fellow && !isNear.has(String(point)) && !this.twins.has(String(fellow))) this.twins.set(String(fellow), point);
    }
    this.points = near.filter((point) => this.twins.has(String(point)));
    return this.look(nearest(this.points, [1, 1]));
  }

  /** Shows a point and its twin. */
  async look(point) {
    if (!point || String(point) === String(this.point)) return;
    Object.assign(this, { point });
    const twin = this.twins.get(String(point)) ?? point;
    for (const middle of [[0, 0], twin]) {
      await this.request(middle);
      if (point !== this.point) return;
    }
    this.pair = [point, twin];
    this.tell();
    this.stage.draw();
  }

  /** Vectors are what separates a point of seed 0, without warp, from its place on the grid. */
  async request(/** @type {number[]} */ [x, y]) {
    const box = [x - AROUND, y - AROUND, x + AROUND, y + AROUND].join();
    if (this.asked?.has(box)) return;
    const answer = await this.stage.fetch(`/v1/points?bbox=${box}&spacing=${1 / this.pattern.t}&seed=0&warp=off`);
    if (!answer) return;
    this.asked = (this.asked ?? new Set()).add(box);
    for (const point of answer.points) {
      const [column, row] = point.id.split(":").map(Number);
      this.vectors.set(point.id, [point.x - column, point.y - row]);
    }
  }

  restart() {
    Object.assign(this, { seconds: 0, share: 0 });
  }

  step(seconds) {
    if (this.vectors.size === 0) return true;
    this.seconds += seconds;
    const round = 2 * (WAY + STAY);
    const last = ROUNDS * round - WAY - STAY;
    const at = Math.min(this.seconds, last) % round;
    const way = at < STAY ? 0 : at < STAY + WAY ? (at - STAY) / WAY : at < 2 * STAY + WAY ? 1 : 1 - (at - 2 * STAY - WAY) / WAY;
    this.set(this.seconds >= last ? 1 : eased(way));
    return this.seconds < last;
  }

  finish() {
    this.set(1);
  }

  set(share) {
    this.share = share;
    this.slider?.set(Math.round(100 * share));
  }

  tell() {
    const vectors = this.pair.map((point) => this.vectors.get(point.join(":")));
    if (!vectors.every(Boolean)) return;
    const [here, there] = this.pair.map(([column, row]) => `column ${whole(column)}, row ${whole(row)}`);
    const [x, y] = vectors[0].map(signed);
    this.isAlike = vectors[0].every((v, axis) => Math.abs(v - vectors[1][axis]) < 1e-6);
    this.stage.say(`The ringed points, of ${here} and of ${there}, are in the same block${this.isAlike ? " and have the same" : ", but not the same"} vector: (${x}, ${y}) steps of the grid.`);
  }

  draw(context, width, height, colors) {
    const [here, there] = this.pair;
    const range = (x, y) => [[x - REACH, y - REACH], [x + REACH, y + REACH]];
    this.panels = pair(width, height, range(0, 0), range(there[0] - here[0], there[1] - here[1]));
    this.panels.forEach((panel, i) => this.window(context, panel, this.pair[i], colors));
    this.stage.name(`Two windows of the pattern far from each other, with the same points around a ringed one on their way along their vectors. Arrow keys choose a point.`);
  }

  window(context, panel, chosen, colors) {
    const { pattern } = this;
    panel.clipped(context, () => {
      const along = Array.from({ length: 2 * REACH + 1 }, (_, i) => i);
      lines(context, along.map((v) => [panel.to([panel.x0 + v, panel.y0]), panel.to([panel.x0 + v, panel.y1])]), colors.line, 0.5);
      lines(context, along.map((v) => [panel.to([panel.x0, panel.y0 + v]), panel.to([panel.x1, panel.y0 + v])]), colors.line, 0.5);
      const ways = pointsAround(pattern, panel).map((point) => this.way(panel, point));
      lines(context, ways.map(({ from, end }) => [from, end]), colors.vector, 1);
      for (const { now, color } of ways) disk(context, now, dotOf(panel.scale), color);
      if (this.vectors.size === 0) return;
      const { from, end, now } = this.way(panel, chosen);
      arrow(context, from, end, colors.vector, 3);
      disk(context, now, panel.scale * 0.75, colors.block, 2.5);
    });
    panel.frame(context, colors.line);
  }

  /** The way of a point in pixels: where it begins, ends, and is now; and its color. */
  way(panel, point) {
    const vector = this.vectors.get(point.join(":")) ?? [0, 0];
    const [from, now, end] = [0, this.share, 1].map((share) => panel.to(point.map((v, axis) => v + share * vector[axis])));
    return { from, now, end, color: colorOf(this.pattern, indexOf(this.pattern, point)) };
  }
}

/** The points of a panel's window, and those that may come into it. */
function pointsAround(pattern, { x0, y0, x1, y1 }) {
  const found = [];
  for (let y = y0 - 6; y <= y1 + 6; y += 1) {
    for (let x = x0 - 6; x <= x1 + 6; x += 1) if (pattern.has(x, y)) found.push([x, y]);
  }
  return found;
}
