// What is left to choose: how dense, which seed, how much warp. All points are the server's; they move by their addresses.

import { settled } from "../dom.js";
import { Panel, disk, eased } from "./pen.js";
import { Figure } from "./stage.js";

/** The window in units of the plane, and what is requested around it. */
const WIDE = 12;
const HIGH = 6;
const AROUND = 0.5;
/** Points of a square of so many places of the grid have one shade. */
const SQUARE = 16;
/** The seconds of a way, and until the next one. */
const WAY = 1.4;
const STAY = 1.3;

/** @typedef {{ density: number, seed: number, warp: number }} Chosen */

/**
 * What is shown by itself, one after another.
 * @type {Chosen[]}
 */
const TOUR = [
  { density: 3, seed: 0, warp: 0 },
  { density: 9, seed: 0, warp: 0 },
  { density: 9, seed: 7, warp: 0 },
  { density: 9, seed: 7, warp: 2 },
  { density: 9, seed: 7, warp: 1 },
];

export class Seeds extends Figure {
  /** @type {((chosen: Chosen) => void) | undefined} */
  follow;
  /** @type {Chosen} */
  chosen;
  stop = 0;
  isTaken = false;
  seconds = 0;
  share = 0;

  constructor() {
    super();
    this.known = new Map();
    this.from = new Map();
    this.to = new Map();
    this.later = settled(120, () => this.go());
    this.restart();
  }

  restart() {
    Object.assign(this, { stop: 0, seconds: 0, share: 1, isTaken: false, chosen: { ...TOUR[0] } });
    if (this.stage) this.go();
  }

  /** Requests the points of what is chosen, and has them move there. */
  async go() {
    this.follow?.(this.chosen);
    const { density, seed, warp } = this.chosen;
    const key = `density=${density}&seed=${seed}&warp=${warp}`;
    const box = [-AROUND, -AROUND, WIDE + AROUND, HIGH + AROUND].join();
    if (!this.known.has(key)) {
      const answer = await this.stage.fetch(`/v1/points?bbox=${box}&${key}`);
      if (!answer) return;
      this.known.set(key, new Map(answer.points.map(({ id, x, y }) => [id, [x, y]])));
    }
    this.from = this.to;
    this.to = this.known.get(key);
    this.shown = key;
    this.share = this.from.size === 0 || this.isStill ? 1 : 0;
    this.tell();
    this.stage.draw();
    if (this.share < 1 && this.stage.isOver) this.stage.goOn();
  }

  step(seconds) {
    if (this.to.size === 0) return true;
    this.share = Math.min(1, this.share + seconds / WAY);
    // After a choice of the visitor points go there, and no further.
    if (this.isTaken) return this.share < 1;
    this.seconds += seconds;
    if (this.seconds < WAY + STAY) return true;
    this.seconds = 0;
    this.stop += 1;
    if (this.stop >= TOUR.length) return false;
    this.chosen = { ...TOUR[this.stop] };
    this.go();
    return true;
  }

  /** The tour ends where it is; a visitor who wants no motion sees its last stop. */
  finish() {
    this.share = 1;
    this.isTaken = true;
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    this.isStill = true;
    this.chosen = { ...TOUR[TOUR.length - 1] };
  }

  choose(change) {
    Object.assign(this.chosen, change);
    this.later();
  }

  tell() {
    const { density, seed, warp } = this.chosen;
    const inside = [...this.to.values()].filter(([x, y]) => x >= 0 && y >= 0 && x < WIDE && y < HIGH).length;
    const bent = warp === 0 ? "no warp" : `warp ${warp}`;
    this.stage.say(`Density ${density}, seed ${seed}, ${bent}: ${inside} points in this window of ${WIDE} × ${HIGH}, from the server.`);
  }

  draw(context, width, height, colors) {
    const panel = new Panel([1, 1, width - 2, height - 2], [0, 0], [WIDE, HIGH]);
    const share = eased(this.share);
    const radius = panel.scale * 0.17 * this.chosen.density ** -0.5 + 0.5;
    panel.clipped(context, () => {
      for (const [id, place] of this.to) {
        const before = this.from.get(id);
        const at = before ? place.map((v, axis) => before[axis] + share * (v - before[axis])) : place;
        const [column, row] = id.split(":").map((v) => Math.floor(Number(v) / SQUARE));
        context.globalAlpha = before || this.from.size === 0 ? 1 : share;
        disk(context, panel.to(at), radius, (column + row) % 2 === 0 ? colors.ink : colors.index);
      }
      for (const [id, place] of this.share < 1 ? this.from : []) {
        if (this.to.has(id)) continue;
        context.globalAlpha = 1 - share;
        disk(context, panel.to(place), radius, colors.soft);
      }
    });
    panel.frame(context, colors.line);
    this.stage.name(`${this.to.size} points in two shades, by squares of their addresses: the squares are straight without warp and bent with it.`);
  }
}
