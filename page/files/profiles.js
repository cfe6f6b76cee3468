// The tables of a server, as the panel offers them: which there are of a profile, and in what order.

/** The uses of the built-in profiles. */
export const PROFILE_WORDS = {
  blue: "Even and without direction: the one to start with.",
  sharp: "Even with sharper order, close to the best of its kind.",
  spaced: "Points keep as far apart as they can.",
  lloyd: "Centers of their own cells, almost a honeycomb.",
  step: "No low frequencies at all, the rest random.",
  green: "Clusters of one size, evenly strewn.",
  pink: "Clouds of all sizes, as in nature.",
  "single-peak": "One frequency stands out.",
  pattern: "The bare pattern, not yet moved by a table.",
};

export const MAP_WORDS = { s: "s (small)", m: "m (medium)", l: "l (large)" };

const STANDARD = "(5-sqrt(3))/2";

/** The names of profiles, each once. */
export function profileNames(tables) {
  return [...new Set(tables.map((table) => table.profile))];
}

/** The choices of a layer: `{ alphas, alpha, isStandard(alpha), maps, map }`. */
export function choicesOf(tables, layer) {
  const own = tables.filter((table) => table.profile === layer.profile);
  const alphas = [...new Set(own.map((table) => table.alpha))];
  const standard = alphas.includes(STANDARD) || alphas.length === 0 ? STANDARD : alphas[0];
  const alpha = layer.alpha || standard;
  const maps = own.filter((table) => table.alpha === alpha).map((table) => table.map);
  maps.sort((a, b) => "sml".indexOf(a) - "sml".indexOf(b));
  return { alphas: including(alphas, alpha), alpha, standard, maps: including(maps, layer.map || maps[0] || "s"), map: layer.map || maps[0] || "s" };
}

/** α as people write it. */
export function nice(alpha) {
  return alpha.replace(/sqrt\((\d+)\)/g, "√$1");
}

/** A list with a value in it. */
export function including(list, value) {
  return list.includes(value) ? list : [...list, value];
}
