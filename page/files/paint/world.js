// Worlds as files: what the page shows, as the server reads it from a folder of worlds, and back.

import { wordsOf } from "../api.js";
import { Digits, json } from "../digits.js";
import { bodyOf, memberOf } from "../query.js";
import { send } from "../sent.js";
import { AMOUNTS, LAYER, MOST_LAYERS } from "../state.js";
import { fieldOf, paintedIn, read, written } from "./strokes.js";

/** The text of the world that layers are: what queries of it have in common, without a region. */
export function worldOf(layers) {
  const world = layers.length === 1 ? memberOf(layers[0], 1, true) : bodyOf(layers, undefined, 1, {}, true);
  return `${json(world, 2)}\n`;
}

/** The members that a layer of a world may have for the page to show it. */
const MEMBERS = [
  "name", "profile", "alpha", "map", ...AMOUNTS, "seed", "warp", "settle", "field", "attributes", "scale_range",
  "variants", "clear_of",
];

/** The values of each point that a layer shows. */
const ATTRIBUTES = ["angle", "scale", "variant"];

/** Reads JSON whose seeds keep their digits, above 2⁵³ too: they become `Digits`. */
function parsed(text) {
  const marked = text.replace(/("seed"\s*:\s*)(-?\d+)(?![\d.eE])/g, '$1"\\u0000$2"');
  const isMarked = (key, value) => key === "seed" && typeof value === "string" && value.startsWith("\u0000");
  return JSON.parse(marked, (key, value) => (isMarked(key, value) ? new Digits(value.slice(1)) : value));
}

/** Refuses members of a file that this page would lose. */
function known(object, members, name) {
  const unknown = Object.keys(object).find((member) => !members.includes(member));
  if (unknown) throw new Error(`“${name}” is not a world that this page can show: it does not know \`${unknown}\`.`);
}

/** The layers of a world's text. Fields that it describes are sent. */
export async function layersOf(text, name) {
  let world;
  try {
    world = parsed(text);
  } catch (error) {
    throw new Error(`“${name}” is not JSON: ${wordsOf(error)}`);
  }
  const list = world?.layers ?? [world];
  if (!Array.isArray(list) || list.length < 1 || list.length > MOST_LAYERS) {
    throw new Error(`“${name}” has no layers that this page shows: from 1 to ${MOST_LAYERS} are possible.`);
  }
  for (const set of list) {
    if (!set || typeof set !== "object") throw new Error(`“${name}” is not a world that this page can show: a layer is not an object.`);
    known(set, MEMBERS, name);
  }
  if (world.layers) known(world, ["layers", "seed"], name);
  if (world.layers && "seed" in world && !list.every((set) => "seed" in set)) {
    throw new Error(`“${name}” has layers whose seeds come from a common one: this page needs a \`seed\` in each layer.`);
  }
  const clears = list.map((set, i) => clearOf(set, list.slice(0, i), name));
  return Promise.all(list.map((set, i) => layerOf(set, i, name, clears[i])));
}

/** The one distance that a layer keeps from all layers before it, as text. */
function clearOf({ clear_of: distances }, before, name) {
  if (distances === undefined) return "";
  const [distance, ...others] = before.map((set) => distances?.[set.name]);
  const isOne = typeof distance === "number" && others.every((other) => other === distance);
  if (!isOne || Object.keys(distances).length !== before.length) {
    throw new Error(`“${name}” has a layer whose \`clear_of\` this page cannot show: it keeps one distance from all layers above.`);
  }
  return String(distance);
}

async function layerOf(set, i, name, clear) {
  const by = AMOUNTS.find((amount) => amount in set);
  if (!by) throw new Error(`“${name}” has a layer without ${AMOUNTS.join(", ")}: one of them is needed.`);
  const layer = { ...LAYER, color: i, by, amount: String(set[by]), seed: textOf(set.seed ?? 0), clear };
  for (const member of ["profile", "alpha", "map", "warp", "settle"]) if (member in set) layer[member] = String(set[member]);
  if (set.field) Object.assign(layer, await fieldFrom(set.field));
  for (const attribute of [set.attributes ?? []].flat()) {
    if (!ATTRIBUTES.includes(attribute)) throw new Error(`“${name}” has an attribute that this page does not show: \`${attribute}\`.`);
    layer[attribute] = true;
  }
  if (set.scale_range) layer.range = [set.scale_range].flat().join(",");
  if (set.variants) {
    const { variants } = set;
    layer.variants = typeof variants === "string" ? variants : Object.entries(variants).map((pair) => pair.join(":")).join(",");
  }
  return layer;
}

/** A layer's field and what is painted in it, if it was painted here. Fields that are described are sent. */
async function fieldFrom(field) {
  if (typeof field === "string") return { field };
  const painted = paintedIn(field);
  if (!painted) return { field: await send(field) };
  const { below } = painted;
  const base = below ? below.name ?? await send(below) : "";
  const paint = written({ ...painted, base });
  return { field: await send(fieldOf(read(paint)), field), paint };
}

/** A seed as the field for it has it. */
function textOf(seed) {
  return seed instanceof Digits ? seed.text : String(seed);
}
