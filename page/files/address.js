// What addresses hold behind their hash: names and values. What one does not say, or says wrongly, stays at its default.

import { parsePlace } from "./place.js";

/** Whether a text is a seed: an integer of 64 bits. */
export function isSeed(text) {
  return /^\d{1,20}$/.test(text) && BigInt(text) < 2n ** 64n;
}

/** Reads the hash of an address. */
export function givenIn(/** @type {string} */ hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  return {
    size: given.size,
    has: (/** @type {string} */ name) => given.has(name),
    /** The text of a name, or nothing. */
    text: (/** @type {string} */ name) => given.get(name) ?? "",
    /** The text of a name if it has a form. */
    matching: (/** @type {string} */ name, /** @type {RegExp} */ form, otherwise = "") => {
      const text = given.get(name);
      return text !== null && form.test(text) ? text : otherwise;
    },
    /** A number within bounds. */
    number: (/** @type {string} */ name, /** @type {number} */ otherwise, /** @type {number[]} */ [least, most] = [-Infinity, Infinity]) => {
      const value = given.has(name) ? Number(given.get(name)) : NaN;
      return Number.isFinite(value) ? Math.max(least, Math.min(most, value)) : otherwise;
    },
    /** The coordinates of a place; those that are none are `null`. */
    at: () => (given.get("at") ?? "").split(",").map(parsePlace),
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
