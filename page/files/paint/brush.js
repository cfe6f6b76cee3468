// The hand on the plane while something is painted: mouse, pen, finger or keys draw a line in world units. Two fingers
// and the wheel move the view as always.

import { contextOf } from "../dom.js";
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
    /** @type {Map<number, number[]>} */
    this.down = new Map();
    /** @type {number[][] | null} */
    this.line = null;
    /** @type {number[] | null} */
    this.cursor = null;
    this.size = 1;
    this.kind = "paint";
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.lift(event));
    canvas.addEventListener("pointerleave", () => this.down.size > 0 || this.point(null));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      plane.zoom(Math.exp(-Math.max(-240, Math.min(240, event.deltaY)) * 0.0022), this.pixel(event));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("focus", () => this.point(this.cursor ?? this.world([plane.view.width / 2, plane.view.height / 2])));
  }

  pixel(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
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

  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, this.pixel(event));
    // A second finger means that the view is to move.
    this.line = this.down.size === 1 ? [this.world(this.pixel(event))] : null;
    this.point(this.world(this.pixel(event)));
  }

  move(event) {
    const before = this.down.get(event.pointerId);
    const now = this.pixel(event);
    if (before && this.down.size === 2) this.pinch(event.pointerId, now);
    else if (before && this.line) this.line.push(this.world(now));
    if (before) this.down.set(event.pointerId, now);
    if (before || event.pointerType === "mouse") this.point(this.world(now));
  }

  pinch(id, now) {
    const [, other] = [...this.down].find(([key]) => key !== id) ?? [];
    const before = this.down.get(id);
    if (!other || !before) return;
    const apart = (/** @type {number[]} */ a) => Math.hypot(a[0] - other[0], a[1] - other[1]) || 1;
    this.plane.drag((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    this.plane.zoom(apart(now) / apart(before), [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]);
  }

  lift(event) {
    if (!this.down.delete(event.pointerId)) return;
    if (event.type === "pointerup") this.finish();
    this.line = null;
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
      this.down.clear();
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
