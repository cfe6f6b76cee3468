// A forest in perspective for the card of the walk, on a plain canvas: its trees are points of the server.

import { ask } from "./api.js";

/** How far to each side and ahead points are requested, in world units, and how far apart they are. */
const [SIDE, AHEAD, SPACING] = [46, 78, 2.3];
/** The height of the eye, and how large a unit at distance 1 is, as a share of the picture's height. */
const EYE = 3.1;
const LENS = 0.95;
/** Where the horizon is, as a share of the picture's height from its top. */
const HORIZON = 0.46;

/** The colors of a day and of dusk, as red, green and blue. */
const LIGHTS = {
  day: { sky: [[150, 190, 222], [244, 240, 222]], ground: [[160, 178, 118], [206, 210, 176]], lit: [64, 124, 70], dark: [30, 82, 58], path: [206, 190, 150] },
  dusk: { sky: [[36, 34, 74], [226, 122, 86]], ground: [[18, 30, 34], [92, 66, 74]], lit: [38, 66, 66], dark: [14, 30, 38], path: [88, 74, 80] },
};

const mixed = (a, b, t) => a.map((v, i) => v + (b[i] - v) * t);
const css = (rgb) => `rgb(${rgb.map(Math.round).join(" ")})`;
/** The middle of the trail at a distance ahead. */
const trail = (ahead) => 7 * Math.sin(ahead / 15) - 0.05 * ahead;

/** The trees of the picture, the farthest first: `[x, ahead, height]`. */
export async function grove() {
  const path = `/v1/points?bbox=${-SIDE},0,${SIDE},${AHEAD}&spacing=${SPACING}&seed=7&attributes=scale&scale_range=0.7,1.3&format=f32`;
  const packed = new Float32Array(await (await ask(path)).arrayBuffer());
  const trees = [];
  for (let k = 0; k < packed.length; k += 3) {
    const [x, ahead] = [packed[k] - SIDE, packed[k + 1] + 4];
    if (Math.abs(x - trail(ahead)) > 2.6) trees.push([x, ahead, 4.6 * packed[k + 2]]);
  }
  return trees.sort((a, b) => b[1] - a[1]);
}

/** Draws the trees by day, or at dusk. */
export function drawGrove({ context, width, height }, trees, isDark) {
  const { sky, ground, lit, dark, path } = LIGHTS[isDark ? "dusk" : "day"];
  const level = height * HORIZON;
  const fade = (from, to, [above, below]) => {
    const gradient = context.createLinearGradient(0, from, 0, to);
    gradient.addColorStop(0, css(above));
    gradient.addColorStop(1, css(below));
    context.fillStyle = gradient;
  };
  fade(0, level, sky);
  context.fillRect(0, 0, width, level);
  fade(level, height, [ground[1], ground[0]]);
  context.fillRect(0, level, width, height - level);
  const at = (x, ahead, up) => [width / 2 + (x / ahead) * LENS * height, level + ((EYE - up) / ahead) * LENS * height];
  const polygon = (corners, color) => {
    context.fillStyle = color;
    context.beginPath();
    for (const [x, y] of corners) context.lineTo(x, y);
    context.fill();
  };
  const steps = Array.from({ length: 60 }, (_, i) => 2 + (i * i) / 40);
  const edge = (side) => steps.map((ahead) => at(trail(ahead) + side, ahead, 0));
  polygon([...edge(-1.5), ...edge(1.5).reverse()], css(path));
  for (const [x, ahead, tall] of trees) {
    // What is far away takes the color of the sky above the horizon.
    const haze = 1 - Math.exp(-ahead / 38);
    const [left, right] = [css(mixed(lit, sky[1], haze)), css(mixed(dark, sky[1], haze * 0.92))];
    for (const [low, high, wide] of [[0.12, 0.62, 0.3], [0.34, 0.82, 0.23], [0.58, 1, 0.15]]) {
      const [top, foot] = [at(x, ahead, tall * high), at(x, ahead, tall * low)];
      const reach = (wide * tall * LENS * height) / ahead;
      polygon([top, [foot[0] - reach, foot[1]], [foot[0] + reach * 0.25, foot[1] + reach * 0.16]], left);
      polygon([top, [foot[0] + reach * 0.25, foot[1] + reach * 0.16], [foot[0] + reach, foot[1]]], right);
    }
  }
}
