// Worlds as files: what the page shows, as the server reads it from a folder of worlds, and back.

import { bodyOf, json, memberOf } from "../query.js";
import { send } from "../sent.js";
import { AMOUNTS, LAYER, MOST_LAYERS } from "../state.js";

/** The text of the world that layers are: what queries of it have in common, without a region. */
export function worldOf(layers) {
  const world = layers.length === 1 ? memberOf(layers[0], 1, true) : bodyOf(layers, undefined, 1, {}, true);
  return `${json(world, 2)}\n`;
}

/** What a layer of a world may have for the page to show it. */
const MEMBERS = [
  "name", "profile", "alpha", "map", ...AMOUNTS, "seed", "warp", "field", "attributes", "scale_range", "variants",
  "clear_of",
];

/** The layers of a world's text. Fields that it describes are sent. */
export async function layersOf(text, name) {
  let world;
  try {
    // A seed above 2⁵³ keeps its digits as text.
    world = JSON.parse(text.replace(/("seed"\s*:\s*)(\d+)/g, '$1"$2"'));
  } catch (error) {
    throw new Error(`“${name}” is no JSON: ${error.message}`);
  }
  const list = world?.layers ?? [world];
  if (!Array.isArray(list) || list.length < 1 || list.length > MOST_LAYERS) {
    throw new Error(`“${name}” has no layers that this page shows: from 1 to ${MOST_LAYERS} are possible.`);
  }
  return Promise.all(list.map((set, i) => layerOf(set, i, name)));
}

async function layerOf(set, i, name) {
  const unknown = Object.keys(set ?? {}).find((member) => !MEMBERS.includes(member));
  if (!set || typeof set !== "object" || unknown) {
    throw new Error(`“${name}” is no world that this page shows: ${unknown ? `it does not know \`${unknown}\`` : "a layer is no object"}.`);
  }
  const by = AMOUNTS.find((amount) => amount in set);
  if (!by) throw new Error(`“${name}” has a layer without ${AMOUNTS.join(", ")}: one of them is needed.`);
  const layer = { ...LAYER, color: i, by, amount: String(set[by]), seed: String(set.seed ?? 0) };
  for (const member of ["profile", "alpha", "map", "warp"]) if (member in set) layer[member] = String(set[member]);
  if (set.field) layer.field = typeof set.field === "string" ? set.field : await send(set.field);
  for (const attribute of [set.attributes ?? []].flat()) if (attribute in LAYER) layer[attribute] = true;
  if (set.scale_range) layer.range = [set.scale_range].flat().join(",");
  if (set.variants) {
    const { variants } = set;
    layer.variants = typeof variants === "string" ? variants : Object.entries(variants).map((pair) => pair.join(":")).join(",");
  }
  const [clear] = Object.values(set.clear_of ?? {});
  if (clear) layer.clear = String(clear);
  return layer;
}
