// A row of places and one hand that turns by α a place: where it stands in the gate, there is a point.

import { Pattern, turns } from "./pattern.js";
import { Panel, dial, disk, eased, line, words } from "./pen.js";
import { Figure } from "./stage.js";

/** The places that are shown. */
const SHOWN = 24;
/** The seconds that the hand takes for a step, and stays. */
const TURNS = 0.36;
const STAYS = 0.16;

export const degrees = (turn, digits = 1) => `${(turn * 360).toFixed(digits)}°`;

export class Row extends Figure {
  /** @type {((at: number) => void) | undefined} */
  told;
  at = 0;
  visited = 0;

  constructor() {
    super();
    this.pattern = new Pattern();
    this.first = 0;
    this.restart();
  }

  restart() {
    Object.assign(this, { first: 0, at: 0, seconds: 0, visited: 0 });
  }

  /** Where the hand stands at a place, in turns. */
  turn(place) {
    return turns(this.pattern.along(place, 0));
  }

  step(seconds) {
    this.seconds += seconds;
    if (this.seconds > TURNS + STAYS) {
      this.seconds -= TURNS + STAYS;
      this.at += 1;
      this.visited = this.at;
    }
    this.tell();
    return this.at < SHOWN - 1;
  }

  finish() {
    Object.assign(this, { visited: SHOWN - 1, seconds: 0 });
    if (this.at === 0) this.at = 5;
    this.tell();
  }

  /** Another α: half turns between 1 and 2. */
  choose(alpha) {
    this.pattern = new Pattern(alpha);
    this.tell();
  }

  /** Looks at a place, however far. */
  go(place) {
    if (place < this.first || place >= this.first + SHOWN) this.first = Math.max(0, place - SHOWN / 2);
    this.at = place;
    this.visited = this.first + SHOWN - 1;
    this.tell();
  }

  touched(at) {
    const place = Math.round(this.panels[0].from(at)[0]);
    this.go(Math.min(this.first + SHOWN - 1, Math.max(this.first, place)));
  }

  moved([right]) {
    this.go(Math.max(0, this.at + right));
  }

  tell() {
    const { at, pattern } = this;
    this.told?.(at);
    const isPoint = this.turn(at) < pattern.t;
    const whole = Math.floor((at * pattern.alpha) / 2);
    const full = whole === 0 ? "" : `, which is ${whole.toLocaleString("en")} full turn${whole === 1 ? "" : "s"} and ${degrees(this.turn(at))}`;
    const sum = ((at * pattern.alpha) / 2) * 360;
    // As many digits of α as a product of that size needs.
    const factor = degrees(pattern.alpha / 2, String(at).length);
    const product = `${at.toLocaleString("en")} × ${factor} = ${sum.toLocaleString("en", { maximumFractionDigits: 1 })}°`;
    this.stage?.say(`Place ${at.toLocaleString("en")}: ${product}${full}. The gate ends at ${degrees(pattern.t)}, so there is ${isPoint ? "a point" : "no point"} here.`);
  }

  draw(context, width, height, colors) {
    const { pattern } = this;
    const radius = Math.min(height * 0.4, width * 0.15);
    const from = this.turn(this.at);
    const share = this.visited === this.at ? eased(Math.max(0, Math.min(1, (this.seconds - STAYS) / TURNS))) : 0;
    const hand = from + share * (pattern.alpha / 2);
    dial(context, [radius + 4, height / 2], radius, pattern.t, hand);
    const left = 2 * radius + 26;
    const chart = new Panel([left, 8, width - left - 8, height - 46], [this.first - 0.5, 0], [this.first + SHOWN - 0.5, 1]);
    this.panels = [chart];
    chart.fill(context, [chart.x0, 0], [SHOWN, pattern.t], colors.gate, 0.25);
    line(context, chart.to([chart.x0, 0]), chart.to([chart.x1, 0]), colors.edge);
    line(context, chart.to([chart.x0, pattern.t]), chart.to([chart.x1, pattern.t]), colors.gate, 1.5);
    line(context, chart.to([chart.x0, 1]), chart.to([chart.x1, 1]), colors.line);
    const bottom = height - 24;
    for (let place = this.first; place < this.first + SHOWN; place += 1) {
      const [x] = chart.to([place, 0]);
      const isPast = place <= this.visited;
      const turn = this.turn(place);
      const isPoint = isPast && turn < pattern.t;
      if (isPast) disk(context, chart.to([place, turn]), 3, isPoint ? colors.gate : colors.index);
      if (isPoint) line(context, chart.to([place, turn]), [x, bottom], colors.gate, 1);
      disk(context, [x, bottom], Math.min(chart.scale * 0.36, isPoint ? 6 : 3.5), isPoint ? colors.ink : colors.edge, isPoint ? 0 : 1);
    }
    const [x] = chart.to([this.at, 0]);
    line(context, [x, 8], [x, bottom], colors.index, 1);
    disk(context, [x, bottom], Math.min(9, chart.scale * 0.48), colors.index, 2);
    words(context, this.at.toLocaleString("en"), [Math.min(width - 20, Math.max(left + 8, x)), height - 7], colors.soft, 11);
    this.stage.name(`A dial with a hand, and the hand's position at ${SHOWN} places of a row; where it lies in the gate, the place has a point. Arrow keys choose a place.`);
  }
}
