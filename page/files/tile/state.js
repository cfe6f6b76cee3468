// The state of the page of a tile, and its form in the address.

import { place } from "../place.js";

/** The first state; `points` is the least number, the server takes the next period. */
const START = { what: "points", profile: "blue", points: 5041, share: 1, seed: "7", seams: true, size: 128, bits: "8" };

/** The sides of masks, in pixels. */
export const SIZES = [32, 64, 128, 256, 512];

/** The least share of the points. */
export const LEAST_SHARE = 0.02;

/** Reads the hash; what it does not say, or says wrongly, stays at its default. */
export function fromHash(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const state = { ...START, x: place(0), y: place(0), span: spanOf(START) };
  /** @type {(name: string, pattern: RegExp, read?: (text: string) => any) => void} */
  const take = (name, pattern, read = String) => {
    const text = given.get(name) ?? "";
    if (pattern.test(text)) state[name] = read(text);
  };
  take("what", /^(points|mask)$/);
  take("profile", /^[\w.-]{1,64}$/);
  take("points", /^[1-9]\d{0,9}$/, Number);
  take("share", /^(1|0?\.\d{1,6})$/, (text) => Math.max(LEAST_SHARE, Number(text)));
  take("seed", /^\d{1,20}$/);
  take("seams", /^[01]$/, (text) => text === "1");
  take("bits", /^(8|16)$/);
  if (SIZES.includes(Number(given.get("size")))) state.size = Number(given.get("size"));
  state.span = spanOf(state);
  return state;
}

/** How much of a tile the shorter side shows at first. */
export function spanOf({ what, size }) {
  return what === "mask" ? 1.2 * size : 60;
}

/** Writes the hash: what is not a default, so that a link shows the same tile. */
export function toHash(state) {
  const names = state.what === "mask" ? ["profile", "size", "bits", "seed", "seams"] : ["profile", "points", "share", "seed", "seams"];
  const said = names.filter((name) => state[name] !== START[name]).map((name) => {
    const value = typeof state[name] === "boolean" ? Number(state[name]) : state[name];
    return `${name}=${encodeURIComponent(value)}`;
  });
  return `#${[`what=${state.what}`, ...said].join("&")}`;
}
