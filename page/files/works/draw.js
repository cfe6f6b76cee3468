// The three drawings of the laboratory: the plane, the index torus, the set region.

import { contextOf } from "../dom.js";
import { themeColor } from "../theme.js";

/** A square drawing with coordinates of its own, y upward. */
export class Square {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = contextOf(canvas);
    this.side = 1;
    this.from = 0;
    this.scale = 1;
  }

  /** Begins anew: the range of both coordinates, the same for x and y. */
  begin(from, to) {
    const side = this.canvas.clientWidth || 280;
    const ratio = Math.min(2, globalThis.devicePixelRatio || 1);
    const pixels = Math.round(side * ratio);
    if (this.canvas.width !== pixels) Object.assign(this.canvas, { width: pixels, height: pixels });
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.clearRect(0, 0, side, side);
    this.side = side;
    this.from = from;
    this.scale = side / (to - from);
    return this;
  }

  x(v) {
    return (v - this.from) * this.scale;
  }

  y(v) {
    return this.side - (v - this.from) * this.scale;
  }

  /** The coordinates of a pointer. */
  at(event) {
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    return [this.from + x / this.scale, this.from + (this.side - y) / this.scale];
  }

  dot([x, y], radius, color) {
    const { context } = this;
    context.fillStyle = color;
    context.beginPath();
    context.arc(this.x(x), this.y(y), radius, 0, 2 * Math.PI);
    context.fill();
  }

  ring([x, y], radius, color) {
    const { context } = this;
    context.strokeStyle = color;
    context.lineWidth = 2;
    context.beginPath();
    context.arc(this.x(x), this.y(y), radius, 0, 2 * Math.PI);
    context.stroke();
  }

  fill([x, y], [width, height], color) {
    this.context.fillStyle = color;
    this.context.fillRect(this.x(x), this.y(y + height), width * this.scale, height * this.scale);
  }

  outline([x, y], [width, height], color, thickness = 1.5) {
    this.context.strokeStyle = color;
    this.context.lineWidth = thickness;
    this.context.strokeRect(this.x(x), this.y(y + height), width * this.scale, height * this.scale);
  }

  line([x, y], [u, v], color, thickness = 1) {
    const { context } = this;
    context.strokeStyle = color;
    context.lineWidth = thickness;
    context.beginPath();
    context.moveTo(this.x(x), this.y(y));
    context.lineTo(this.x(u), this.y(v));
    context.stroke();
  }
}

/** The colors at the corners of the set region: (0, 0), (t, 0), (0, t), (t, t). */
const CORNERS = [[42, 98, 190], [219, 68, 92], [28, 158, 108], [232, 172, 40]];

/** The color of a place in the set region, from 0 to 1 along both axes; `lift` is how far it goes toward white. */
export function shade([u, v], lift = 0) {
  const weights = [(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v];
  const mixed = [0, 1, 2].map((channel) => CORNERS.reduce((sum, color, i) => sum + color[channel] * weights[i], 0));
  return `rgb(${mixed.map((v) => Math.round(v + lift * (255 - v))).join(" ")})`;
}

/** Colors of the theme that drawings use. */
export function colors() {
  const names = ["ink", "soft", "line", "accent", "ground", "raised"];
  const known = Object.fromEntries(names.map((name) => [name, themeColor(name)]));
  const classes = Array.from({ length: 7 }, (_, i) => {
    const probe = document.createElement("i");
    probe.className = `swatch-${i + 1}`;
    document.body.append(probe);
    const { backgroundColor } = getComputedStyle(probe);
    probe.remove();
    return backgroundColor;
  });
  return { ...known, classes };
}
