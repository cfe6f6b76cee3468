// One point, from its address to the server's answer: hands, block, vector, warp, and the line for curl.

import { byId, make } from "../dom.js";
import { Pattern, intervalOf, nearest, turns } from "./pattern.js";
import { degrees } from "./dials.js";
import { Panel, arrow, disk } from "./pen.js";
import { Figure } from "./stage.js";

/** The window in mean spacings, with a spacing of 1. */
const WIDE = 10;
const HIGH = 5;
const QUERY = "spacing=1&seed=7";
const SEED = 7n;
/** How far the table's points see. */
const RADIUS = 100;
/** How far away the other window is. */
const FAR = 1e9;

const MASK = (1n << 64n) - 1n;

/** SplitMix64's output for a state. */
function mix(state) {
  let z = (state + 0x9e3779b97f4a7c15n) & MASK;
  z = ((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n) & MASK;
  z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & MASK;
  return z ^ (z >> 31n);
}

/** Where the hands of the seed stand at column 0, row 0. */
const START = [mix(SEED), mix(mix(SEED) ^ SEED)];

/** The hands and the block of a place of the seed's pattern, `{ hands, block }`. */
function computed(pattern, starts, address) {
  const index = pattern.index(...address).map((v, axis) => (v + START[axis]) & MASK);
  return { hands: index.map(turns), block: index.map((v) => intervalOf(starts, v)) };
}

const grouped = (v) => v.toLocaleString("en").replace("-", "−");
const rounded = (v) => v.toFixed(2).replace("-", "−");

export class Served extends Figure {
  /** @type {string | undefined} */
  id;
  /** @type {number[][] | null} */
  path;

  constructor() {
    super();
    this.pattern = new Pattern();
    this.starts = this.pattern.starts(RADIUS);
    this.corner = [0, 0];
    this.ids = new Map();
  }

  get isFar() {
    return this.corner[0] !== 0;
  }

  /** Requests the points of the window, then the one nearest to its middle. */
  async load() {
    const [x, y] = this.corner;
    const answer = await this.stage.fetch(`/v1/points?bbox=${[x, y, x + WIDE, y + HIGH].join()}&${QUERY}`);
    if (!answer) return;
    // As seen from the corner, so that nothing is lost far away.
    this.points = answer.points.map((point) => [point.x - x, point.y - y]);
    this.ids = new Map(answer.points.map(({ id }, i) => [String(this.points[i]), id]));
    this.look(nearest(this.points, [WIDE / 2, HIGH / 2]));
  }

  jump() {
    this.corner = this.isFar ? [0, 0] : [FAR, FAR];
    byId("served-far").textContent = this.isFar ? "Back to the origin" : "A billion away";
    this.load();
  }

  /** Requests a point by its id, with the warp and without. */
  async look(point) {
    const id = this.ids.get(String(point));
    if (id === this.id) return;
    Object.assign(this, { point, id, path: null });
    const line = `/v1/points/${id}?${QUERY}`;
    byId("served-command").textContent = `curl '${location.origin}${line}'`;
    const plain = await this.stage.fetch(`${line}&warp=off`);
    const answer = plain && (await this.stage.fetch(line));
    if (!answer) return;
    byId("served-answer").textContent = JSON.stringify(answer.point);
    this.tell(answer.point, plain.point);
    this.stage.draw();
  }

  tell({ id, x, y, block }, plain) {
    const address = id.split(":").map(Number);
    const { hands, block: own } = computed(this.pattern, this.starts, address);
    const { t } = this.pattern;
    const grid = address.map((v) => v * t);
    const vector = [plain.x - grid[0], plain.y - grid[1]];
    this.path = [grid, [plain.x, plain.y], [x, y]].map((place) => place.map((v, axis) => v - this.corner[axis]));
    const agrees = String(own) === String(block) ? "the server says so, too" : `the server says ${block.join(", ")}`;
    const step = (name, color, text) => make("li", {}, make("b", { class: color }, name), " ", text);
    byId("served-steps").replaceChildren(
      step("Address:", "", `column ${grouped(address[0])}, row ${grouped(address[1])}.`),
      step("Hands:", "index", `at ${degrees(hands[0])} and ${degrees(hands[1])}, both in the gate, which ends at ${degrees(t)}.`),
      step("Block:", "block", `number ${own[0]} along the first hand, ${own[1]} along the second; ${agrees}.`),
      step("Vector:", "vector", `(${vector.map((v) => rounded(v / t)).join(", ")}) in steps of the grid, from the table.`),
      step("Warp and spacing:", "", `from there to (${[x, y].map((v) => v.toLocaleString("en", { maximumFractionDigits: 4 }).replace("-", "−")).join(", ")}).`),
    );
    this.stage.say(`Point ${id}: the server's answer stands below.`);
    this.isAlike = String(own) === String(block);
  }

  draw(context, width, height, colors) {
    const panel = new Panel([1, 1, width - 2, height - 2], [0, 0], [WIDE, HIGH]);
    this.panels = [panel];
    panel.clipped(context, () => {
      for (const point of this.points) disk(context, panel.to(point), panel.scale * 0.11, point === this.point ? colors.index : colors.ink);
      if (this.point) disk(context, panel.to(this.point), panel.scale * 0.25, colors.index, 2.5);
      if (!this.path) return;
      const [grid, plain, end] = this.path.map((place) => panel.to(place));
      context.strokeStyle = colors.edge;
      context.lineWidth = 1.5;
      context.strokeRect(grid[0] - 4, grid[1] - 4, 8, 8);
      arrow(context, grid, plain, colors.vector, 2.5);
      arrow(context, plain, end, colors.soft, 1.5);
    });
    panel.frame(context, colors.line);
    this.stage.name(`${this.points.length} points of the server; the chosen one with the way from its place on the grid. Arrow keys choose a point.`);
  }
}
