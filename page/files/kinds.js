// The fields for kinds in the tab Choose: how they are spread, their names with their shares, and their colors.

import { byId, make } from "./dom.js";
import { setOptions } from "./form.js";
import { SHAPES, SHAPE_SIGNS, isColored, kindColors } from "./marks.js";
import { choicesOf } from "./profiles.js";
import { allVariants, variantNames } from "./query.js";
import { LAYER } from "./state.js";

const SPREAD_WORDS = {
  "": "Points of one kind",
  chance: "Kinds by chance",
  even: "Kinds, each evenly spread",
  joint: "Kinds, each as even as all together",
};
const ABOUT = {
  chance: "Each point has its kind by chance, so kinds clump.",
  even: "No point moves; which of them are of a kind is chosen evenly. The server prepares new shares once, which takes a while.",
  joint: "On a table made for these shares.",
};
/** The names of kinds until others are typed, and their shares. */
const NAMES = ["birch", "oak", "pine", "rowan", "bush", "fern"];
const SHARES = "birch:1,oak:3";

export class Kinds {
  /** `profiles` are the server's tables. */
  constructor(profiles) {
    this.profiles = profiles;
  }

  /** The shares for which the server has a joint table of a layer's profile and pattern, with its map. */
  joint(layer) {
    const { alpha } = choicesOf(this.profiles, layer);
    const tables = this.profiles.filter((table) => table.profile === layer.profile && table.alpha === alpha && table.joint_kinds?.length > 0);
    return tables.find((table) => table.map === layer.map) ?? tables[0];
  }

  changed(spread) {
    const { layer } = this;
    const members = { spread };
    if (spread && layer.variants === LAYER.variants) members.variants = SHARES;
    if (spread === "joint") {
      const { joint_kinds: ratios, map } = this.joint(layer);
      const ratio = ratioOf(members.variants ?? layer.variants);
      if (!ratios.includes(ratio)) members.variants = named(ratios[0]);
      members.map = map;
    } else if (layer.spread === "joint") members.map = "";
    if (spread) members.variant = false;
    return members;
  }

  /** Shows a layer of those that there are. */
  update(layer, layers) {
    this.layer = layer;
    const ratios = this.joint(layer)?.joint_kinds ?? [];
    const offered = Object.keys(SPREAD_WORDS).filter((spread) => spread !== "joint" || ratios.length > 0 || layer.spread === "joint");
    setOptions(byId("spread"), offered.map((spread) => [spread, SPREAD_WORDS[spread]]), layer.spread);
    const ratio = ratioOf(layer.variants);
    const list = ratios.includes(ratio) ? ratios : [...ratios, ratio];
    setOptions(byId("ratio"), list, ratio);
    byId("about-spread").textContent = ABOUT[layer.spread] ?? "";
    const [shares, names] = ["ratio", "variants"].map((id) => /** @type {HTMLElement} */ (byId(id).parentElement));
    shares.hidden = layer.spread !== "joint";
    names.hidden = byId("legend").hidden = !layer.variant && !layer.spread;
    const signs = allVariants(layers);
    const colors = kindColors(layer);
    byId("legend").replaceChildren(...variantNames(layer).map((name, i) => (isColored(layer)
      ? make("span", {}, make("i", { class: `swatch-${colors[i % colors.length]}` }), name)
      : make("span", {}, `${SHAPE_SIGNS[signs.indexOf(name) % SHAPES.length] ?? "●"} ${name}`))));
  }
}

/** The ratio of shares, as the server writes it: in increasing order. */
function ratioOf(variants) {
  return variants.split(",").map((one) => Number(one.split(":")[1] ?? 1)).sort((a, b) => a - b).join(":");
}

/** Names for the shares of a ratio. */
export function named(ratio) {
  return ratio.split(":").map((share, i) => `${NAMES[i % NAMES.length]}:${share}`).join(",");
}
