// How points look: the size of a dot at a zoom, and the shapes of marks.

import { allVariants, variantNames } from "./query.js";
import { COLOR_NAMES, KIND_COLORS } from "./state.js";

/** Shapes by the number of a variant; beyond the last one they begin again. */
export const SHAPES = [
  "circle", "triangle", "square", "diamond", "cross", "ring", "open triangle", "open square", "open diamond", "bar",
];
/** The characters that stand for the shapes in words. */
export const SHAPE_SIGNS = ["●", "▲", "■", "◆", "✚", "○", "△", "□", "◇", "▬"];
/** The shape of a point with an angle and no variant. */
export const ARROW = SHAPES.length;

/** The diameter of a dot in CSS pixels, where neighbors are a number of pixels apart. */
function dotSize(gap, factor) {
  return Math.min(14, Math.max(1.1, gap * 0.3)) * factor;
}

/** The diameter of a mark that has a direction or a shape: larger, so that it can be recognized. */
function markSize(gap, factor) {
  return Math.min(36, Math.max(2.5, gap * 0.62)) * factor;
}

/** Whether a layer's points are more than dots. */
export function isMarked(layer) {
  return layer.angle || layer.variant;
}

/** Whether a layer's points are of kinds, each of which has a color of its own. */
export function isColored(layer) {
  return Boolean(layer.spread);
}

/** The numbers of the colors of a layer's kinds, in their order; with more kinds than colors they begin again. */
export function kindColors(layer) {
  const isOfWoods = layer.color >= KIND_COLORS;
  const [first, count] = isOfWoods ? [KIND_COLORS, COLOR_NAMES.length - KIND_COLORS] : [0, KIND_COLORS];
  return Array.from({ length: count }, (_, i) => first + ((layer.color - first + i) % count));
}

/** The colors of a layer's points by the numbers of their kinds, which count through the kinds of all layers. */
export function tonesOf(layers, i, colors) {
  const own = variantNames(layers[i]);
  const order = kindColors(layers[i]);
  return allVariants(layers).map((name) => colors[order[Math.max(0, own.indexOf(name)) % order.length]]);
}

/** The largest factor by which a layer's values enlarge its points. */
function most(layer) {
  const [, high] = layer.range.split(",").map(Number);
  return layer.scale && high > 0 ? high : 1;
}

/** The share of a kept distance that belongs to the points that were there first. */
const FIRST = 0.65;

/**
 * The diameters of the points of layers in CSS pixels, before their own scales: `unit` is how much of the world a pixel
 * is. Points that keep clear of others are drawn so small that they do not touch, as they do not.
 */
export function sizesOf(layers, spacings, unit) {
  const sizes = layers.map((layer, i) => (isMarked(layer) ? markSize : dotSize)(spacings[i] / unit, layer.dot));
  const limit = (i, radius) => (sizes[i] = Math.max(1.1, Math.min(sizes[i], (2 * radius) / most(layers[i]))));
  layers.forEach((layer, i) => {
    for (let j = 0; j < i; j += 1) {
      const clear = Number(layer.clears?.[j] ?? layer.clear) / unit;
      if (!(clear > 0)) continue;
      limit(j, FIRST * clear);
      limit(i, clear - (sizes[j] * most(layers[j])) / 2);
    }
  });
  return sizes;
}

/** Where a layer finds its values in a record, −1 for what it does not show. */
export function slotsOf(layer, columns) {
  const slot = (name) => (layer[name] ? 2 + columns.indexOf(name) : -1);
  const variant = layer.variant || isColored(layer) ? 2 + columns.indexOf("variant") : -1;
  return { angle: slot("angle"), scale: slot("scale"), variant };
}
