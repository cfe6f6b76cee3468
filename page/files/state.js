// The state of the page, and its form in the address: everything that is not a default is in the
// hash, so that a link shows the same view.

import { givenIn, hashOf } from "./address.js";
import { decimalsFor, formatPlace, place } from "./place.js";

/** The amounts that an unbounded plane can have, by the names that requests use. */
const AMOUNTS = ["spacing", "density", "min_distance"];

/** How kinds can be spread; no word for points of one kind. */
const SPREADS = ["", "chance", "even", "joint"];

/** Colors by number: the ink of the theme, seven that Okabe and Ito chose, and three of woods. */
export const COLOR_NAMES = ["ink", "blue", "vermilion", "green", "orange", "sky", "purple", "yellow", "stone", "leaf", "moss"];

/** The number of colors that kinds go through from the first on; those of woods go to the end. */
export const KIND_COLORS = 8;

/** A layer before anything is chosen: texts as in requests, and how its points look. */
export const LAYER = {
  profile: "blue",
  alpha: "",
  map: "",
  /** One of `AMOUNTS`. */
  by: "spacing",
  amount: "1",
  seed: "1",
  warp: "",
  settle: "",
  field: "",
  /** What is painted, as text. */
  paint: "",
  /** The share of the points that is shown, those of lowest rank; nothing for all. */
  lod: "",
  /** Whether the field is shown. */
  shade: false,
  /** Whether it is a picture, dark on light in both themes. */
  paper: false,
  /** An index of `COLOR_NAMES`. */
  color: 0,
  /** The size of dots: 1 is the usual one. */
  dot: 1,
  /** Whether angles are shown, and so on. */
  angle: false,
  scale: false,
  range: "0.5,1.5",
  variant: false,
  variants: "oak:3,birch:1,pine:2",
  /** One of `SPREADS`. */
  spread: "",
  /** The distance to the layers before. */
  clear: "",
};

/**
 * A layer. One of a world has its name there, the columns of its points, the distances to the layers before one by one, and
 * what the server says of it.
 * @typedef {typeof LAYER & { world?: { name: string, seed: string }, name?: string, columns?: string[], clears?: number[], understood?: any }} Layer
 */

/** The most characters of a painting in the address; a longer one is in the requests of Take alone. */
export const MOST_PAINT = 16_000;

/** The most layers that the page offers. */
export const MOST_LAYERS = 6;

/** @typedef {import("./place.js").Place} Place */

/** @typedef {ReturnType<typeof initial>} State What the address holds. */

/** The view of a visitor who comes without a link: some 900 points, more in a large window. */
export function initial() {
  const enlarged = Math.max(1, Math.min(globalThis.innerWidth, globalThis.innerHeight) / 900);
  return {
    x: place(0),
    y: place(0),
    /** The length of the shorter side of the view. */
    span: Math.round(30 * enlarged),
    /** The name of the server's world that is shown, or nothing; and another seed than its own. */
    world: "",
    worldSeed: "",
    /** @type {Layer[]} */
    layers: [{ ...LAYER }],
    tab: "start",
    /** What is taken away: nothing for the view, or what repeats, `tile` or `mask`. */
    take: "",
    /** What is said of an address that was not understood in full. */
    wrong: /** @type {string | null} */ (null),
  };
}

/** Reads the hash of an address; what it does not say stays at its default. */
export function fromHash(/** @type {string} */ hash) {
  const given = givenIn(hash);
  const state = initial();
  const [x, y] = given.at();
  if (x && y) Object.assign(state, { x, y });
  state.span = given.number("span", state.span, [Number.MIN_VALUE, Infinity]);
  if (given.size > 0) state.tab = "choose";
  state.tab = given.matching("tab", (text) => /^(start|choose|understand|take|gallery)$/.test(text), state.tab);
  state.take = given.matching("take", (text) => /^(tile|mask)$/.test(text));
  state.world = given.matching("world", (text) => /^[\w.-]{1,64}$/.test(text));
  state.worldSeed = given.matching("world.seed", (text) => /^\d{1,20}$/.test(text));
  const layers = Math.trunc(given.number("layers", 1, [1, MOST_LAYERS]));
  state.layers = Array.from({ length: layers }, (_, i) => layerFrom(given, i));
  state.wrong = given.wrong();
  return state;
}

function layerFrom(given, i) {
  const layer = { ...LAYER, color: i };
  for (const member of Object.keys(LAYER)) {
    const name = named(member, i);
    if (!given.has(name)) continue;
    const text = given.text(name);
    if (typeof LAYER[member] === "boolean") layer[member] = text === "1";
    else if (typeof LAYER[member] === "number") {
      if (Number.isFinite(Number(text))) layer[member] = Number(text);
    } else layer[member] = text;
  }
  if (!AMOUNTS.includes(layer.by)) layer.by = LAYER.by;
  if (!SPREADS.includes(layer.spread)) layer.spread = LAYER.spread;
  if (!(Number(layer.lod) > 0 && Number(layer.lod) < 1)) layer.lod = LAYER.lod;
  layer.color = Math.abs(Math.trunc(layer.color)) % COLOR_NAMES.length;
  layer.dot = Math.min(4, Math.max(0.25, layer.dot));
  return layer;
}

/** The name of a key for the layer of an index: those of further layers begin with their number. */
function named(key, i) {
  return i === 0 ? key : `${i + 1}.${key}`;
}

/** Writes the hash of an address. */
export function toHash(/** @type {State} */ state) {
  const decimals = decimalsFor(state.span) + 5;
  const said = [
    ["at", `${formatPlace(state.x, decimals)},${formatPlace(state.y, decimals)}`],
    ["span", String(Number(state.span.toPrecision(8)))],
  ];
  if (state.world) said.push(["world", state.world]);
  if (state.world && state.worldSeed) said.push(["world.seed", state.worldSeed]);
  // The layers of a world are the server's.
  const layers = state.world ? [] : state.layers;
  if (layers.length > 1) said.push(["layers", String(layers.length)]);
  layers.forEach((layer, i) => {
    for (const member of Object.keys(LAYER)) {
      const standard = member === "color" ? i : LAYER[member];
      const must = member === "profile" || member === "amount" || member === "seed";
      if (!must && layer[member] === standard) continue;
      if (member === "paint" && layer.paint.length > MOST_PAINT) continue;
      const value = typeof layer[member] === "boolean" ? (layer[member] ? "1" : "0") : String(layer[member]);
      said.push([named(member, i), value]);
    }
  });
  if (state.tab !== "choose") said.push(["tab", state.tab]);
  if (state.take) said.push(["take", state.take]);
  return hashOf(said);
}
