// The grid with two hands, and beside it the square of indices, which the places of the grid fill evenly.

import { Pattern, turns } from "./pattern.js";
import { degrees } from "./dials.js";
import { dial, disk, disks, line, pair, palette } from "./pen.js";
import { Figure } from "./stage.js";

/** The colors at the corners of the set region: (0, 0), (t, 0), (0, t), (t, t). */
const CORNERS = [[42, 98, 190], [219, 68, 92], [28, 158, 108], [232, 172, 40]];
/** How far toward white colors go on a dark ground. */
const LIFT = 0.35;

/** The grid has places from 0 to this along both axes. */
const LAST = 20;
/** Places that are walked in a second, at first and at last. */
const RATES = [3, 120];

/** The index of a place, in turns. */
export function indexOf(/** @type {Pattern} */ pattern, /** @type {number[]} */ [x, y]) {
  return pattern.index(x, y).map(turns);
}

/** The color of a point by its index: lighter on a dark ground. */
export function colorOf(pattern, index) {
  const [u, v] = index.map((at) => at / pattern.t);
  const weights = [(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v];
  const lift = palette().isDark ? LIFT : 0;
  const mixed = [0, 1, 2].map((channel) => CORNERS.reduce((sum, color, i) => sum + color[channel] * weights[i], 0));
  return `rgb(${mixed.map((value) => Math.round(value + lift * (255 - value))).join(" ")})`;
}

export class Indices extends Figure {
  walked = 0;

  constructor() {
    super();
    this.pattern = new Pattern();
    this.places = Array.from({ length: (LAST + 1) ** 2 }, (_, i) => [i % (LAST + 1), Math.floor(i / (LAST + 1))]);
    this.indices = this.places.map((place) => indexOf(this.pattern, place));
    this.restart();
  }

  restart() {
    Object.assign(this, { walked: 0, seconds: 0 });
  }

  get at() {
    return this.places[Math.floor(this.walked)];
  }

  step(seconds) {
    this.seconds += seconds;
    const share = Math.min(1, this.seconds / 7);
    this.walked = Math.min(this.places.length - 1, this.walked + seconds * (RATES[0] + (RATES[1] - RATES[0]) * share ** 2));
    this.tell();
    return this.walked < this.places.length - 1;
  }

  finish() {
    if (this.walked === 0) this.walked = 3 * (LAST + 1) + 7;
    this.tell();
  }

  /** @param {number[]} place */
  go([x, y]) {
    const [column, row] = [x, y].map((v) => Math.min(LAST, Math.max(0, Math.round(v))));
    this.walked = row * (LAST + 1) + column;
    this.tell();
  }

  touched(at) {
    const [grid, square] = this.panels;
    if (grid.holds(at)) return this.go(grid.from(at));
    if (!square.holds(at)) return;
    const [u, v] = square.from(at);
    const far = (/** @type {number[]} */ [a, b]) => (a - u) ** 2 + (b - v) ** 2;
    const best = this.indices.reduce((one, index, i) => (far(index) < far(this.indices[one]) ? i : one), 0);
    this.go(this.places[best]);
  }

  moved([right, up]) {
    const [x, y] = this.at;
    this.go([x + right, y + up]);
  }

  tell() {
    const index = this.indices[Math.floor(this.walked)];
    const [first, second] = index.map((turn) => turn < this.pattern.t);
    const said = first && second ? "Both are in their gates: a point." : first || second ? "One of them is outside its gate: no point." : "Both are outside their gates: no point.";
    this.stage?.say(`Column ${this.at[0]}, row ${this.at[1]}: the first hand stands at ${degrees(index[0])}, the second at ${degrees(index[1])}. ${said}`);
  }

  draw(context, width, height, colors) {
    const { t } = this.pattern;
    this.panels = pair(width, height, [[-0.7, -0.7], [LAST + 0.7, LAST + 0.7]], [[0, 0], [1, 1]], 0.415);
    const [grid, square] = this.panels;
    const { top, width: side } = grid;
    const done = this.stage.isOver ? this.places.length : Math.floor(this.walked) + 1;
    square.fill(context, [0, 0], [t, t], colors.gate, 0.25);
    const all = this.places.map((place, i) => ({ place, index: this.indices[i], isDone: i < done }));
    const points = all.filter(({ index, isDone }) => isDone && index.every((v) => v < t));
    disks(context, all.map(({ place }) => grid.to(place)), Math.max(0.7, grid.scale * 0.07), colors.edge);
    disks(context, all.filter(({ isDone }) => isDone).map(({ index }) => square.to(index)), Math.max(1.3, side / 180), colors.edge);
    for (const { place, index } of points) {
      const color = colorOf(this.pattern, index);
      disk(context, grid.to(place), grid.scale * 0.36, color);
      disk(context, square.to(index), Math.max(2.2, side / 110), color);
    }
    square.outline(context, [0, 0], [t, t], colors.gate, 2);
    square.frame(context, colors.edge);
    grid.frame(context, colors.line);
    const index = this.indices[Math.floor(this.walked)];
    const radius = Math.min(width * 0.062, side * 0.24);
    const centers = [0.27, 0.73].map((share) => [width / 2, top + side * share]);
    dial(context, centers[0], radius, t, index[0]);
    dial(context, centers[1], radius, t, index[1]);
    disk(context, grid.to(this.at), Math.max(4, grid.scale * 0.6), colors.index, 2);
    const seen = square.to(index);
    context.globalAlpha = 0.6;
    line(context, [seen[0], top + side], seen, colors.index);
    line(context, [square.left, seen[1]], seen, colors.index);
    context.globalAlpha = 1;
    disk(context, seen, 5, colors.index, 2);
    this.stage.name(`Left a grid of ${LAST + 1} by ${LAST + 1} places; in the middle the two hands of one place; right the square of indices, with the gate in its lower left corner. Arrow keys choose a place.`);
  }
}
