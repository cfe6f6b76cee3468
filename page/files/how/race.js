// Two pieces of Poisson disks that are made at the same time, or one after the other, and where they clash.

import { streamOf } from "../hash.js";
import { Panel, disks, line, lines, words } from "./pen.js";
import { Figure } from "./stage.js";

/** The sides of a piece, in widths of a piece, and the least distance. */
const HEIGHT = 1.02;
const LEAST = 0.098;
/** A piece is full after this many darts in a row that found no room. */
const PATIENCE = 500;
/** Darts thrown in a second at each piece: few at first, so that they can be followed. */
const SLOW = 26;
const FAST = 1800;
const SPEEDS_UP = 5;

const near = (/** @type {number[]} */ [x, y], /** @type {number[]} */ [u, v]) => Math.hypot(x - u, y - v) < LEAST;

export class Race extends Figure {
  /** @type {() => number} */
  next;
  /** @type {number[][][]} */
  pieces;
  /** @type {number[]} */
  misses;
  /** @type {number[][]} */
  missed;
  due = 0;

  constructor() {
    super();
    this.seed = 11;
    this.isTogether = true;
    this.restart();
  }

  restart() {
    this.next = streamOf(this.seed);
    this.seed += 1;
    Object.assign(this, { pieces: [[], []], misses: [0, 0], missed: [], seconds: 0, due: 0 });
  }

  begin(together) {
    this.isTogether = together;
    this.restart();
  }

  /** Throws a dart at a piece. One after the other, it keeps clear of both. */
  dart(i) {
    const at = [i + this.next(), this.next() * HEIGHT];
    const others = this.isTogether ? this.pieces[i] : this.pieces.flat();
    if (others.some((point) => near(point, at))) {
      this.misses[i] += 1;
      this.missed.push(at);
    } else {
      this.pieces[i].push(at);
      this.misses[i] = 0;
    }
  }

  isFull(i) {
    return this.misses[i] >= PATIENCE;
  }

  /** The pieces that darts are thrown at. */
  get open() {
    const open = [0, 1].filter((i) => !this.isFull(i));
    return this.isTogether ? open : open.slice(0, 1);
  }

  step(seconds) {
    this.seconds += seconds;
    this.missed = [];
    const share = Math.min(1, this.seconds / SPEEDS_UP);
    this.due += seconds * (SLOW + (FAST - SLOW) * share ** 4);
    for (; this.due >= 1; this.due -= 1) for (const i of this.open) this.dart(i);
    this.tell();
    return this.open.length > 0;
  }

  finish() {
    while (this.open.length > 0) for (const i of this.open) this.dart(i);
    this.missed = [];
    this.tell();
  }

  /** The pairs across the border that are too close. */
  get clashes() {
    const [left, right] = this.pieces.map((piece) => piece.filter(([x]) => Math.abs(x - 1) < LEAST));
    return left.flatMap((a) => right.filter((b) => near(a, b)).map((b) => [a, b]));
  }

  tell() {
    const clashes = this.clashes.length;
    const isDone = this.open.length === 0;
    if (!isDone && this.stage?.isMoving) {
      const [left, right] = this.pieces.map((piece) => piece.length);
      const waits = !this.isTogether && !this.isFull(0) ? "The right piece waits. " : "";
      return this.stage.say(`${waits}${left} points on the left, ${right} on the right; a cross is a dart that found no room.`);
    }
    this.stage?.say(this.isTogether
      ? `Both pieces are full, and ${clashes} pairs across the border are too close.`
      : "No clash. But the right piece had to wait for the left one, as each would on a plane without an edge.");
  }

  draw(context, width, height, colors) {
    const panel = new Panel([1, 1, width - 2, height - 2], [0, 0], [2, HEIGHT]);
    const radius = (LEAST / 2) * panel.scale;
    panel.clipped(context, () => {
      const all = this.pieces.flat().map((point) => panel.to(point));
      disks(context, all, radius, colors.soft, 0.16);
      disks(context, all, panel.scale * 0.0125, colors.ink);
      for (const at of this.missed.slice(-12)) {
        const [x, y] = panel.to(at);
        line(context, [x - 3, y - 3], [x + 3, y + 3], colors.soft);
        line(context, [x - 3, y + 3], [x + 3, y - 3], colors.soft);
      }
      const clashes = this.clashes.map((both) => both.map((point) => panel.to(point)));
      disks(context, clashes.flat(), radius, colors.clash, 0.3);
      disks(context, clashes.flat(), panel.scale * 0.016, colors.clash);
      lines(context, clashes, colors.clash, 2);
    });
    context.setLineDash([6, 5]);
    line(context, panel.to([1, 0]), panel.to([1, HEIGHT]), colors.edge, 1.5);
    context.setLineDash([]);
    panel.frame(context, colors.line);
    if (!this.isTogether && !this.isFull(0)) words(context, "waits …", panel.to([1.5, HEIGHT / 2]), colors.soft, 15);
    const [left, right] = this.pieces.map((piece) => piece.length);
    this.stage.name(`Two pieces side by side, ${left} points on the left, ${right} on the right, ${this.clashes.length} pairs too close across the border.`);
  }
}
