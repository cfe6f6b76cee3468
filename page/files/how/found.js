// How arrows are found: those of all blocks begin by chance, and points push each other away.

import { streamOf } from "../hash.js";
import { colorOf, indexOf } from "./indices.js";
import { Pattern, blockOf, nearest } from "./pattern.js";
import { Panel, disk, dotOf, lines } from "./pen.js";
import { Figure } from "./stage.js";

/** An α that is near the standard one and a fraction, so the pattern repeats after `SIDE` places; and how far points look. */
const ALPHA = 49 / 30 + 1e-9;
const SIDE = 60;
const RADIUS = 6;
/** How far chance moves points at most, the rounds of pushing, how strong a push is, and the share of a move that goes on. */
const FAR = 2;
const ROUNDS = 240;
const PUSH = 0.3;
const GOES_ON = 0.6;
/** How far pushes reach, in mean spacings: they fall to nothing beyond a few times as many. */
const REACH = 0.8;

/** A distance on the torus that the pattern is on. */
const wrapped = (v) => v - SIDE * Math.round(v / SIDE);

export class Found extends Figure {
  seed = 3;
  round = 0;
  least = Infinity;
  /** @type {Record<"arrows" | "moves" | "places" | "pushes", number[][]>} */
  now;

  constructor() {
    super();
    this.pattern = new Pattern(ALPHA);
    const places = Array.from({ length: SIDE ** 2 }, (_, i) => [i % SIDE, Math.floor(i / SIDE)]);
    this.points = places.filter(([x, y]) => this.pattern.has(x, y));
    this.spacing = SIDE / Math.sqrt(this.points.length);
    const starts = this.pattern.starts(RADIUS);
    const names = this.points.map((point) => blockOf(this.pattern, starts, point));
    /** The points of each block, by their numbers; for each point its block. */
    this.blocks = [...new Set(names)].map((name) => names.flatMap((other, i) => (other === name ? [i] : [])));
    this.blockOf = this.points.map((_, i) => this.blocks.findIndex((block) => block.includes(i)));
    this.colors = this.points.map((point) => indexOf(this.pattern, point));
    this.point = nearest(this.points, [30, 15]);
    this.restart();
  }

  restart() {
    const next = streamOf(this.seed);
    this.seed += 1;
    this.round = 0;
    const arrows = this.blocks.map(() => [FAR * (2 * next() - 1), FAR * (2 * next() - 1)]);
    this.now = { arrows, moves: this.blocks.map(() => [0, 0]), places: [], pushes: [] };
    this.push();
  }

  /** Where each point is now, and by how much its neighbors push it; keeps the least distance of two points. */
  push() {
    const { arrows } = this.now;
    const places = this.points.map((point, i) => point.map((v, axis) => v + arrows[this.blockOf[i]][axis]));
    this.least = Infinity;
    const pushes = places.map(([x, y], i) => {
      const sum = [0, 0];
      places.forEach(([u, v], j) => {
        const [dx, dy] = [wrapped(x - u) / this.spacing, wrapped(y - v) / this.spacing];
        const square = dx * dx + dy * dy;
        if (i === j || square > 16) return;
        this.least = Math.min(this.least, Math.sqrt(square));
        const strength = Math.exp(-square / (2 * REACH * REACH));
        sum[0] += dx * strength;
        sum[1] += dy * strength;
      });
      return sum;
    });
    Object.assign(this.now, { places, pushes });
  }

  /** A round: the arrow of each block follows the mean of what pushes its points. */
  step() {
    const { arrows, moves, pushes } = this.now;
    this.blocks.forEach((block, b) => [0, 1].forEach((axis) => {
      const mean = block.reduce((sum, i) => sum + pushes[i][axis], 0) / block.length;
      moves[b][axis] = GOES_ON * moves[b][axis] + PUSH * mean;
      arrows[b][axis] += moves[b][axis];
    }));
    this.push();
    this.round += 1;
    this.tell();
    return this.round < ROUNDS;
  }

  finish() {
    while (this.round < ROUNDS) this.step();
  }

  /** The points of the block that is chosen, by their numbers. */
  get chosen() {
    return this.blocks[this.blockOf[this.points.indexOf(this.point)]];
  }

  tell() {
    const { length } = this.chosen;
    this.stage?.say(`Round ${this.round}: ${length} points of ${this.points.length} are in the ringed block; the mean of their pushes moves them all. The nearest two of all points are ${this.least.toFixed(2)} mean spacings apart.`);
  }

  draw(context, width, height, colors) {
    const panel = new Panel([1, 1, width - 2, height - 2], [0, 0], [SIDE, SIDE / 2]);
    const { places, pushes } = this.now;
    this.panels = [panel];
    panel.clipped(context, () => {
      lines(context, this.points.map((point, i) => [panel.to(point), panel.to(places[i])]), colors.vector, 1);
      places.forEach((place, i) => disk(context, panel.to(place), dotOf(panel.scale), colorOf(this.pattern, this.colors[i])));
      for (const i of this.chosen) {
        const end = places[i].map((v, axis) => v + 4 * pushes[i][axis]);
        lines(context, [[panel.to(places[i]), panel.to(end)]], colors.clash, 2.5);
        disk(context, panel.to(places[i]), panel.scale, colors.block, 2);
      }
    });
    panel.frame(context, colors.line);
    this.stage.name(`${this.points.length} points, each with the arrow from its place on the grid; those of one block are ringed. Arrow keys choose another block.`);
  }
}
