// How points look: the size of a dot at a zoom, and the shapes of marks. Both painters draw by these.

/** Shapes by the number of a variant; beyond the last one they begin again. */
export const SHAPES = [
  "circle", "triangle", "square", "diamond", "cross", "ring", "open triangle", "open square", "open diamond", "bar",
];
/** The characters that stand for the shapes in words. */
export const SHAPE_SIGNS = ["●", "▲", "■", "◆", "✚", "○", "△", "□", "◇", "▬"];
/** The shape of a point with an angle and no variant. */
export const ARROW = SHAPES.length;

/** The diameter of a dot in CSS pixels, where neighbors are a number of pixels apart. */
export function dotSize(gap, factor) {
  return Math.min(14, Math.max(1.1, gap * 0.3)) * factor;
}

/** The diameter of a mark that has a direction or a shape: larger, so that it can be recognized. */
export function markSize(gap, factor) {
  return Math.min(36, Math.max(2.5, gap * 0.62)) * factor;
}

/** Whether a layer's points are more than dots. */
export function isMarked(layer) {
  return layer.angle || layer.variant;
}

/** Where a layer finds its values in a record, −1 for what it does not show. */
export function slotsOf(layer, columns) {
  const slot = (name) => (layer[name] ? 2 + columns.indexOf(name) : -1);
  return { angle: slot("angle"), scale: slot("scale"), variant: slot("variant") };
}
