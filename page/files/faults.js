// The server's faults of a query, in the words of the page and at its fields.

/** The fields of the page for parameters that have another name there, and those that have the same. */
const PLACES = { spacing: "amount", density: "amount", min_distance: "amount", scale_range: "range", clear_of: "clear" };
const SAME = ["seed", "warp", "settle", "alpha", "map", "profile", "field", "variants", "spread"];

/** The values that each field takes, as a message. */
const TAKES = {
  spacing: "The mean spacing must be a number above 0, such as 1.5.",
  density: "The density must be a number above 0, such as 0.25.",
  min_distance: "The minimum distance must be a number above 0, such as 1.5.",
  seed: "The seed must be a whole number from 0 to 18446744073709551615.",
  warp: "The warp must be off, on or a number from 0 to 2.",
  settle: "The number of steps must be from 0 to 4.",
  scale_range: "Two numbers are needed, the smaller first, such as 0.5,1.5.",
  variants: "Names with weights are needed, such as oak:3,birch:1. A name has letters, digits, _, - or .",
  clear_of: "The distance must be empty, 0, or a number up to 16 mean spacings of the layers above.",
};

/** The faults by field of the page: `{ id: words }`; `""` has those of no field. */
export function faultsOf(error) {
  const found = {};
  for (const fault of error.faults ?? []) {
    const name = fault.field.replace(/^layers\[\d+\]\./, "").replace(/[.[].*$/, "");
    found[SAME.includes(name) ? name : PLACES[name] ?? ""] = wordsFor(name, fault);
  }
  if (Object.keys(found).length === 0) found[""] = error.message;
  return found;
}

function wordsFor(name, { value, detail, allowed }) {
  if (name === "min_distance" && detail.includes("no least distance")) {
    return "Points of this profile may lie as near as they like. Choose a spacing or a density.";
  }
  if (name === "min_distance" && detail.includes("field")) {
    return "A density field allows no minimum distance. Choose a spacing or a density.";
  }
  if (name === "profile") return `This server has no profile “${value}”.`;
  if (name === "field") {
    const isSent = /^[0-9a-f]{64}$/.test(value);
    return isSent
      ? "The server does not hold this picture any more. Send it again, or choose another field."
      : `This server has no field “${value}”: no such field is loaded.`;
  }
  if (name === "alpha") return `This server has no table for the pattern “${value}”: choose one from the list.`;
  if (name === "map") return `This server has no map “${value}” of this profile: choose one from the list.`;
  if (TAKES[name]) return `“${value}” does not work. ${TAKES[name]}`;
  return `“${value}” does not work: ${detail}. Allowed: ${allowed}.`;
}

/** The faults of a layer that the page itself can find. */
export function faultsBefore(layer, i) {
  const text = layer.clear.trim();
  const isDistance = text === "" || (Number.isFinite(Number(text)) && Number(text) >= 0);
  return i === 0 || isDistance ? {} : { clear: `“${text}” does not work. ${TAKES.clear_of}` };
}
