// Worlds of the server by name, as layers: their colors, and where requests name the world in place of its layers.

import { ask, askJson } from "./api.js";
import { joined, worldPairs } from "./query.js";
import { LAYER } from "./state.js";

/** Colors by words in the names of layers; others take the next color. */
/** @type {[RegExp, number][]} */
const COLORS = [[/tree|oak|wood|forest/, 9], [/bush|grass|fern|plant|shrub/, 10], [/rock|stone|boulder|pebble/, 8]];

/** The color of a layer of a world, by its name. */
function colorOf(name, i) {
  return COLORS.find(([words]) => words.test(name ?? ""))?.[1] ?? i;
}

/** The layers of a world, as the server resolves them; `seed` is a common seed, or empty for the world's own. */
export async function layersOfWorld(name, seed) {
  const world = { name, seed };
  const pairs = [...worldPairs(world), ["bbox", "0,0,1e-300,1e-300"]];
  const [{ query }, sample] = await Promise.all([
    askJson(`/v1/count?${joined(pairs)}`),
    ask(`/v1/points?${joined([...pairs, ["format", "f32"]])}`),
  ]);
  // The columns are those of all layers together.
  const columns = JSON.parse(sample.headers.get("strew-columns") ?? "[]").map((column) => column.name).slice(2);
  return (query.layers ?? [query]).map((one, i, all) => {
    const has = (attribute) => (one.attributes ?? []).includes(attribute);
    return {
      ...LAYER, world, columns, understood: one, name: one.name ?? name, profile: one.profile, by: "spacing",
      amount: String(one.spacing), seed: String(one.seed), color: colorOf(one.name, i), dot: 1.3,
      scale: has("scale"), range: (one.scale_range ?? [1, 1]).join(","), angle: false,
      variant: has("variant") && !one.spread, spread: has("variant") && one.spread ? one.spread : "",
      variants: Object.entries(one.variants ?? {}).map((pair) => pair.join(":")).join(","),
      clears: all.slice(0, i).map((before) => one.clear_of?.[before.name] ?? 0),
    };
  });
}
