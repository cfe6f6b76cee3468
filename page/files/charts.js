// Curves and pictures of spectra, drawn by hand on canvases in the colors of the theme.

import { contextOf } from "./dom.js";
import { themeColor } from "./theme.js";
import { fitted } from "./view.js";

/** Makes a canvas ready to draw on, in CSS pixels, with a height by its width. */
function prepared(canvas, aspect) {
  const width = canvas.clientWidth || 280;
  return fitted(canvas, width, Math.round(width * aspect));
}

/** Draws a curve of `[x, y]`, with one `beside` it dashed, for x up to `end` and y up to `top`; `name` names the horizontal axis. */
export function lineChart(canvas, values, { beside = [], end = 3, top = topOf(values, beside), name = "ν", aspect = 0.5 }) {
  const { context, width, height } = prepared(canvas, aspect);
  const [x, y] = [[0, end], [0, top]];
  const frame = { left: 22, right: 6, top: 6, bottom: 20 };
  const px = (v) => frame.left + ((v - x[0]) / (x[1] - x[0])) * (width - frame.left - frame.right);
  const py = (v) => height - frame.bottom - ((v - y[0]) / (y[1] - y[0])) * (height - frame.top - frame.bottom);
  context.font = "11px system-ui, sans-serif";
  context.fillStyle = themeColor("soft");
  context.strokeStyle = themeColor("line");
  context.lineWidth = 1;
  context.textAlign = "center";
  for (let v = x[0]; v <= x[1] + 1e-9; v += 1) {
    line(context, [[px(v), py(y[0])], [px(v), py(y[1])]]);
    context.fillText(String(v), px(v), height - 6);
  }
  context.fillText(name, px(x[1]) - 18, height - 6);
  context.textAlign = "right";
  const step = y[1] > 4 ? 2 : 1;
  for (let v = y[0]; v <= y[1] + 1e-9; v += step) {
    line(context, [[px(x[0]), py(v)], [px(x[1]), py(v)]]);
    context.fillText(String(v), frame.left - 6, py(v) + 4);
  }
  context.save();
  context.beginPath();
  context.rect(frame.left, frame.top - 2, width - frame.left - frame.right, height - frame.top - frame.bottom + 4);
  context.clip();
  for (const curve of [beside, values]) {
    context.strokeStyle = themeColor(curve === values ? "accent" : "soft");
    context.lineWidth = curve === values ? 1.75 : 1.5;
    context.setLineDash(curve === values ? [] : [5, 4]);
    line(context, curve.map(([a, b]) => [px(a), py(b)]));
  }
  context.restore();
}

function line(context, points) {
  context.beginPath();
  points.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.stroke();
}

/** The top of an axis that holds these values, not led astray by a single peak. */
export function topOf(...curves) {
  const all = curves.flat().map(([, value]) => value).filter(Number.isFinite).sort((a, b) => a - b);
  const top = all[Math.floor(all.length * 0.99)] ?? 1;
  return Math.min(8, Math.max(2, Math.ceil(top * 1.1)));
}

/** Draws power around ν = 0: the ground of the theme is 0, its ink twice white noise or more. */
export function spectrumPicture(canvas, image, cells) {
  Object.assign(canvas, { width: cells, height: cells });
  const context = contextOf(canvas);
  const pixels = context.createImageData(cells, cells);
  const [from, to] = ["sunken", "ink"].map((name) => (themeColor(name).match(/[\d.]+/g) ?? []).map(Number));
  image.forEach((power, i) => {
    const share = Math.min(1, Math.sqrt(power / 3));
    for (let c = 0; c < 3; c += 1) pixels.data[4 * i + c] = from[c] + (to[c] - from[c]) * share;
    pixels.data[4 * i + 3] = 255;
  });
  context.putImageData(pixels, 0, 0);
}

/** Draws points x, y of a square of `side` as dots of a radius in pixels; y upward. */
export function pointPicture(canvas, points, side, radius = 1.7) {
  const { context, width } = prepared(canvas, 1);
  context.fillStyle = themeColor("sunken");
  context.fillRect(0, 0, width, width);
  context.fillStyle = themeColor("ink");
  context.beginPath();
  for (let p = 0; p < points.length; p += 2) {
    const [x, y] = [(points[p] / side) * width, width - (points[p + 1] / side) * width];
    if (x > width || y < 0) continue;
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
  }
  context.fill();
}
