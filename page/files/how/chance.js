// Points by chance beside as many of Strew's: they fall one by one, cells and a ring count them.

import { streamOf } from "../hash.js";
import { disk, disks, line, pair, words } from "./pen.js";
import { Figure } from "./stage.js";

/** The side of the square in mean spacings, the points in it, and the cells along a side. */
const SIDE = 10;
const COUNT = SIDE ** 2;
const CELLS = 5;
/** A ring with room for four points, on average, and the seconds that it wanders. */
const RING = Math.sqrt(4 / Math.PI);
const WANDERS = 12;
/** Points that fall in a second. */
const RATE = 22;

const inside = (/** @type {number[][]} */ points, /** @type {number[]} */ [x, y]) => points.filter(([u, v]) => Math.hypot(u - x, v - y) < RING).length;

export class Chance extends Figure {
  /** @type {number[][]} */
  chance;
  fallen = 0;
  /** @type {number[] | null} */
  ring;
  /** @type {number[][] | null} */
  seen;

  constructor() {
    super();
    this.seed = 6;
    this.strew = [];
    this.restart();
  }

  /** The points of both sides. */
  async load() {
    const answer = await this.stage.fetch(`/v1/points?bbox=0,0,${SIDE},${SIDE}&count=${COUNT}&seed=1`);
    if (!answer) return;
    // In no order that could be seen.
    const next = streamOf(5);
    const mixed = answer.points.map(({ x, y }) => ({ at: [x, y], key: next() })).sort((a, b) => a.key - b.key);
    this.strew = mixed.map(({ at }) => at);
    if (this.ring) this.place(this.ring);
    this.stage.draw();
  }

  restart() {
    const next = streamOf(this.seed);
    this.seed += 1;
    this.chance = Array.from({ length: COUNT }, () => [next() * SIDE, next() * SIDE]);
    Object.assign(this, { fallen: 0, seconds: 0, ring: null, seen: null });
  }

  step(seconds) {
    if (this.fallen < COUNT) {
      this.fallen = Math.min(COUNT, this.fallen + RATE * seconds);
      return true;
    }
    this.seconds += seconds;
    const reach = SIDE / 2 - RING;
    this.place([SIDE / 2 + reach * Math.sin(this.seconds * 1.1), SIDE / 2 + reach * Math.cos(this.seconds * 0.77)]);
    return this.seconds < WANDERS;
  }

  finish() {
    this.fallen = COUNT;
    if (!this.ring) this.place([SIDE / 2, SIDE / 2]);
  }

  touched(at) {
    const panel = this.panels.find((one) => one.holds(at));
    if (panel) this.place(panel.from(at));
  }

  moved([right, up]) {
    const [x, y] = this.ring ?? [SIDE / 2, SIDE / 2];
    this.place([x + right * 0.5, y + up * 0.5]);
  }

  /** Puts the ring somewhere, all of it in the square, and counts. */
  place(/** @type {number[]} */ at) {
    const ring = at.map((v) => Math.min(SIDE - RING, Math.max(RING, v)));
    this.ring = ring;
    if (this.strew.length === 0) return;
    const found = [inside(this.chance, ring), inside(this.strew, ring)];
    this.seen ??= found.map((count) => [count, count]);
    this.seen = this.seen.map(([least, most], i) => [Math.min(least, found[i]), Math.max(most, found[i])]);
    const [chance, strew] = this.seen.map(([least, most]) => (least === most ? least : `${least} to ${most}`));
    this.stage.say(`The ring has room for four points. It now holds ${found[0]} on the left and ${found[1]} on the right; so far it has held ${chance} on the left, ${strew} on the right.`);
  }

  draw(context, width, height, colors) {
    const range = [[0, 0], [SIDE, SIDE]];
    this.panels = pair(width, height, range, range);
    const fallen = Math.floor(this.fallen);
    for (const [i, points] of [this.chance, this.strew].entries()) {
      const panel = this.panels[i];
      const shown = points.slice(0, fallen);
      this.cells(context, panel, shown, colors);
      disks(context, shown.map((point) => panel.to(point)), panel.scale * 0.12, colors.ink);
      if (this.ring && this.fallen === COUNT) disk(context, panel.to(this.ring), RING * panel.scale, colors.index, 2.5);
    }
    const label = `${fallen} points by chance on the left, ${Math.min(fallen, this.strew.length)} even points on the right, counted in ${CELLS ** 2} cells each. Arrow keys move the ring.`;
    this.stage.name(label);
  }

  /** Cells, grayer the more points they hold, with their counts. */
  cells(context, panel, points, colors) {
    const size = SIDE / CELLS;
    const counts = new Array(CELLS ** 2).fill(0);
    for (const [x, y] of points) counts[Math.floor(y / size) * CELLS + Math.floor(x / size)] += 1;
    counts.forEach((count, i) => {
      const corner = [(i % CELLS) * size, Math.floor(i / CELLS) * size];
      panel.fill(context, corner, [size, size], colors.soft, Math.min(1, count / 10) * 0.5);
      const small = Math.max(10, panel.scale * 0.5);
      if (points.length > 0) words(context, String(count), panel.to([corner[0] + 0.32, corner[1] + size - 0.36]), colors.ink, small);
    });
    for (let k = 0; k <= CELLS; k += 1) {
      line(context, panel.to([k * size, 0]), panel.to([k * size, SIDE]), colors.line);
      line(context, panel.to([0, k * size]), panel.to([SIDE, k * size]), colors.line);
    }
  }
}
