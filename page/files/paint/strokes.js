// The painting: strokes that make denser, strokes that thin out, and roads; as text for the address, and as a field.

/** The letters of the kinds in the text. */
const KINDS = { p: "paint", e: "erase", r: "road" };
const LETTERS = { paint: "p", erase: "e", road: "r" };
/** Lines of a field have 10,000 vertices at most, and every stroke has two at least. */
const MOST_STROKES = 5000;

/** @typedef {{ kind: string, size: number, strength: number, line: number[][] }} Stroke */

/** Nothing painted yet, over a field that a layer has already. */
export function blank(base = "") {
  return { base, ground: 1, strokes: /** @type {Stroke[]} */ ([]) };
}

/**
 * Reads the text of `written`: `g(0.1)p(8,0.7:1,2/3,4)r(4:0,0/10,10)`. What is no part of it is left out,
 * and so are strokes that no field has room for.
 * Each stroke is `{ kind, size, strength, line }`; sizes are in world units.
 */
export function read(text) {
  const work = blank();
  for (const [, letter, inside] of text.matchAll(/([bgper])\(([^()]*)\)/g)) {
    if (letter === "b" && /^[\w.-]{1,64}$/.test(inside)) work.base = inside;
    else if (letter === "g" && Number(inside) >= 0 && Number(inside) <= 1) work.ground = Number(inside);
    else {
      const [how, places = ""] = inside.split(":");
      const [size, strength = 1] = how.split(",").map(Number);
      const line = places.split("/").map((one) => one.split(",").map(Number));
      const isLine = line.length > 1 && line.every((at) => at.length === 2 && at.every(Number.isFinite));
      if (work.strokes.length === MOST_STROKES) break;
      if (KINDS[letter] && size > 0 && strength >= 0 && strength <= 1 && isLine) work.strokes.push({ kind: KINDS[letter], size, strength, line });
    }
  }
  return work;
}

const short = (value, digits) => String(Number(value.toFixed(Math.min(100, Math.max(0, digits)))));

/** The text of what is painted, with places to a 50th of a stroke's size; empty if nothing is. */
export function written({ base, ground, strokes }) {
  if (strokes.length === 0) return "";
  const parts = strokes.map(({ kind, size: exact, strength, line }) => {
    const size = Number(exact.toPrecision(3));
    const digits = Math.ceil(-Math.log10(size / 50));
    const places = line.map((at) => at.map((v) => short(v, digits)).join(",")).join("/");
    const how = kind === "road" ? String(size) : `${size},${short(strength, 2)}`;
    return `${LETTERS[kind]}(${how}:${places})`;
  });
  return `${base ? `b(${base})` : `g(${short(ground, 2)})`}${parts.join("")}`;
}

/** Lines of strokes as one shape: a share by the distance to them. */
function shapeOf(kind, { size, strength }, lines) {
  const half = size / 2;
  // A road is empty up to its edge; brushes are soft from a half of their radius on.
  const distances = kind === "road" ? [half, half * 1.5] : [half / 2, half];
  const shares = { paint: [strength, 0], erase: [Number((1 - strength).toFixed(4)), 1], road: [0, 1] }[kind];
  return { distance: { lines, distances, shares } };
}

/** Strokes one after another as shapes: neighbors of the same kind, size and strength share one. */
function shapesOf(strokes) {
  const shapes = [];
  for (const stroke of strokes) {
    const last = shapes.at(-1);
    const isSame = last && ["kind", "size", "strength"].every((name) => last[name] === stroke[name]);
    if (isSame) last.lines.push(stroke.line);
    else shapes.push({ ...stroke, lines: [stroke.line] });
  }
  return shapes;
}

/**
 * The field of what is painted, in the grammar of fields; `ofBase(name)` describes the field below. Where strokes of
 * the brush overlap, the denser one counts; erasers multiply, in the order in which all was painted. Roads are last.
 */
export function fieldOf({ base, ground, strokes }, ofBase = (name) => ({ name })) {
  /** @type {Record<string, any>} */
  let field = base ? ofBase(base) : { constant: ground };
  const join = (name, shape) => {
    if (field[name]) field[name].push(shape);
    else field = { [name]: [field, shape] };
  };
  // The field below may be a list itself, which is not ours to add to.
  if (base) field = { max: [field] };
  for (const shape of shapesOf(strokes.filter(({ kind }) => kind !== "road"))) {
    join(shape.kind === "paint" ? "max" : "multiply", shapeOf(shape.kind, shape, shape.lines));
  }
  for (const shape of shapesOf(strokes.filter(({ kind }) => kind === "road"))) join("multiply", shapeOf("road", shape, shape.lines));
  return field;
}

/** A line without the points that lie within a distance of the rest (Douglas and Peucker). */
export function simplified(line, distance) {
  if (line.length < 3) return line;
  const [[x, y], [u, v]] = [line[0], line.at(-1)];
  const length = Math.hypot(u - x, v - y);
  let [farthest, most] = [0, 0];
  line.forEach(([a, b], i) => {
    const away = length > 0 ? Math.abs((u - x) * (y - b) - (x - a) * (v - y)) / length : Math.hypot(a - x, b - y);
    if (away > most) [farthest, most] = [i, away];
  });
  if (most <= distance) return [line[0], line.at(-1)];
  const [before, after] = [line.slice(0, farthest + 1), line.slice(farthest)].map((part) => simplified(part, distance));
  return [...before, ...after.slice(1)];
}
