// What addresses hold behind their hash: names and values. What one does not say, or says wrongly, stays at its default.

import { parsePlace } from "./place.js";

/** Whether a text is a seed: an integer of 64 bits. */
export function isSeed(text) {
  return /^\d{1,20}$/.test(text) && BigInt(text) < 2n ** 64n;
}

/** Reads the hash of an address. */
export function givenIn(/** @type {string} */ hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  /** What nobody has taken yet. */
  const left = new Map(given);
  const take = (/** @type {string} */ name, /** @type {(text: string) => boolean} */ isRight) => {
    const text = given.get(name);
    if (text === null || !isRight(text)) return null;
    left.delete(name);
    return text;
  };
  return {
    size: given.size,
    has: (/** @type {string} */ name) => given.has(name),
    /** The text of a name, or nothing. */
    text: (/** @type {string} */ name) => take(name, () => true) ?? "",
    /** The text of a name if it is right. */
    matching: (/** @type {string} */ name, /** @type {(text: string) => boolean} */ isRight, otherwise = "") => take(name, isRight) ?? otherwise,
    /** A number within bounds. */
    number: (/** @type {string} */ name, /** @type {number} */ otherwise, /** @type {number[]} */ [least, most] = [-Infinity, Infinity]) => {
      const text = take(name, (one) => one.trim() !== "" && Number.isFinite(Number(one)) && Number(one) >= least && Number(one) <= most);
      return text === null ? otherwise : Number(text);
    },
    /** The coordinates of a place; those that are none are `null`. */
    at: () => {
      const places = (given.get("at") ?? "").split(",").map(parsePlace);
      if (places.every(Boolean)) left.delete("at");
      return places;
    },
    /** What is said of an address that was not understood in full, after all that is known was read. */
    wrong: () => {
      const said = [...left].slice(0, 3).map(([name, text]) => `“${name}${text && "="}${text.slice(0, 40)}”`);
      return said.length > 0 ? `This page does not understand ${said.join(", ")} in the address.` : null;
    },
  };
}

/** The hash of pairs of names and values. */
export function hashOf(/** @type {any[][]} */ pairs) {
  return `#${pairs.map(([name, value]) => `${name}=${encoded(String(value))}`).join("&")}`;
}

/** Percent-encodes only what an address cannot hold, so that people can read it. */
export function encoded(/** @type {string} */ text) {
  return encodeURIComponent(text).replace(/%(2C|3A|28|29|2F)/g, (whole) => decodeURIComponent(whole));
}
