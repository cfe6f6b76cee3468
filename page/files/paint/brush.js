// The hand on the plane while something is painted: mouse, pen, finger or keys draw a line in world units. Two fingers
// and the wheel move the view as always.

import { contextOf } from "../dom.js";
import { pinch } from "../gestures.js";
import { followPointers, followWheel } from "../hands.js";
import { themeColor } from "../theme.js";
import { sized } from "../view.js";
import { toNumber } from "../place.js";

/** How far an arrow key moves the cursor, in brush sizes; with Shift four times as far. */
const STEP = 0.5;

export class Brush {
  /** `drawn(line)` takes a whole line; `left()` hears of Escape; `say(words)` is read out. */
  constructor(canvas, plane, { drawn, left, say }) {
    this.canvas = canvas;
    this.plane = plane;
    this.drawn = drawn;
    this.left = left;
    this.say = say;
    /** @type {number[][] | null} */
    this.line = null;
    /** @type {number[] | null} */
    this.cursor = null;
    this.size = 1;
    this.kind = "paint";
    followPointers(canvas, {
      pressed: (at, fingers) => {
        // A second finger means that the view is to move.
        this.line = fingers === 1 ? [this.world(at)] : null;
        this.point(this.world(at));
      },
      moved: (step) => {
        if (step.was) pinch(plane, step);
        else this.line?.push(this.world(step.at));
        this.point(this.world(step.at));
      },
      lifted: (isWhole) => {
        if (isWhole) this.finish();
        this.line = null;
        this.draw();
      },
      hovered: (at) => this.point(at && this.world(at)),
    });
    followWheel(canvas, (factor, at) => plane.zoom(factor, at));
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("focus", () => this.point(this.cursor ?? this.world([plane.view.width / 2, plane.view.height / 2])));
  }

  /** @param {number[]} pixel */
  world([px, py]) {
    const { x, y, unit, width, height } = this.plane.view;
    return [toNumber(x) + (px - width / 2) * unit, toNumber(y) + (height / 2 - py) * unit];
  }

  point(at) {
    this.cursor = at;
    this.draw();
  }

  /** Hands over the line; a tap becomes a very short one. */
  finish() {
    const { line } = this;
    this.line = null;
    if (!line) return;
    const [x, y] = line[0];
    const isTap = line.every(([u, v]) => Math.hypot(u - x, v - y) < this.size / 16);
    this.drawn(isTap ? [[x, y], [x + this.size / 16, y]] : line);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = STEP * this.size * (event.shiftKey ? 4 : 1);
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
    const zooms = { "+": 1.25, "=": 1.25, "-": 0.8, PageUp: 2, PageDown: 0.5 };
    if (moves[event.key]) this.step(moves[event.key]);
    else if (zooms[event.key]) this.plane.zoom(zooms[event.key]);
    else if (event.key === " " || event.key === "Enter") this.pen();
    else if (event.key === "Escape") this.escape();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  step([dx, dy]) {
    const { plane } = this;
    const [x, y] = this.cursor ?? this.world([plane.view.width / 2, plane.view.height / 2]);
    const at = [x + dx, y + dy];
    const { unit, width, height } = plane.view;
    const away = [at[0] - toNumber(plane.view.x), at[1] - toNumber(plane.view.y)];
    // The view follows the cursor.
    if (Math.abs(away[0]) > (width * unit) / 2 || Math.abs(away[1]) > (height * unit) / 2) plane.drag(-dx / unit, dy / unit);
    this.line?.push(at);
    this.point(at);
  }

  pen() {
    if (this.line) {
      this.finish();
      this.say("Pen up");
    } else if (this.cursor) {
      this.line = [this.cursor];
      this.say("Pen down: arrow keys draw, Space ends the line");
    }
    this.draw();
  }

  escape() {
    if (this.line) {
      this.line = null;
      this.say("Line discarded");
      this.draw();
    } else this.left();
  }

  /** Draws the line that is being drawn, and the size of the brush around the cursor. */
  draw() {
    const { canvas, plane, cursor, line } = this;
    const { view } = plane;
    const [width, height] = view.pixels;
    sized(canvas, view.pixels);
    const context = contextOf(canvas);
    context.clearRect(0, 0, width, height);
    const pixel = view.unit / view.ratio;
    const at = (/** @type {number[]} */ [x, y]) => [width / 2 + (x - toNumber(view.x)) / pixel, height / 2 - (y - toNumber(view.y)) / pixel];
    const radius = Math.max(2, this.size / 2 / pixel);
    context.strokeStyle = themeColor(this.kind === "paint" ? "accent" : "bad");
    if (line) {
      context.globalAlpha = 0.35;
      context.lineWidth = 2 * radius;
      context.lineCap = context.lineJoin = "round";
      context.beginPath();
      [...line, ...line.slice(-1)].map(at).forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
      context.stroke();
      context.globalAlpha = 1;
    }
    if (!cursor) return;
    const [x, y] = at(cursor);
    context.lineWidth = 1.5 * view.ratio;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.moveTo(x - 4 * view.ratio, y);
    context.lineTo(x + 4 * view.ratio, y);
    context.moveTo(x, y - 4 * view.ratio);
    context.lineTo(x, y + 4 * view.ratio);
    context.stroke();
  }
}
