// What the page shows, as its address has it: a place in space, where the eye is from there, and what the points are.

import { givenIn, hashOf, isSeed } from "../address.js";
import { formatPlace, place, toNumber } from "../place.js";

/** The profiles of points in space. */
const PROFILES = ["blue", "spaced"];
/** The fewest and the most mean spacings that points are drawn within. */
export const REACH = [8, 24];
/** The steepest look up or down, in radians. */
export const STEEPEST = 1.5;
/** The farthest place in mean spacings: the server tells neighbors apart a little farther. */
const FARTHEST = 1e11;

/** The middle of a chunk, so that its outline is around the middle of the view. */
const MIDDLE = () => [place(4), place(4), place(4)];
/** @type {Record<string, any>} */
const BEGINNING = { yaw: 30, pitch: -18, away: 30, reach: 16, spacing: "1", seed: "7", profile: "blue" };

/** @typedef {import("../place.js").Place} Place */

/** @typedef {ReturnType<typeof fromHash>} State What the address holds. */

/** Whether a text is a spacing that this page shows. */
export function isSpacing(text) {
  return /^\d*\.?\d+(e[+-]?\d+)?$/i.test(text) && Number(text) >= 1e-3 && Number(text) <= 1e6;
}

/** Whether the server has points of this spacing around a place of three coordinates. */
export function isInReach(at, spacing) {
  return at.every((one) => one && Math.abs(toNumber(one)) <= FARTHEST * Number(spacing));
}

/** The state of an address, with what is said of it where it was not understood in full. */
export function fromHash(hash) {
  const given = givenIn(hash);
  const number = (/** @type {string} */ name, /** @type {number[]} */ bounds) => given.number(name, BEGINNING[name], bounds);
  const spacing = given.matching("spacing", isSpacing, BEGINNING.spacing);
  const at = given.has("at") ? given.at() : MIDDLE();
  const isNear = at.length === 3 && isInReach(at, spacing);
  const turn = Math.PI / 180;
  const state = {
    /** The place that is looked at. */
    at: isNear ? /** @type {Place[]} */ (at) : MIDDLE(),
    yaw: number("yaw", [-360, 360]) * turn,
    pitch: Math.max(-STEEPEST, Math.min(STEEPEST, number("pitch", [-90, 90]) * turn)),
    /** How far the eye is, and how far points are drawn, in mean spacings. */
    away: number("away", [0, 4 * REACH[1]]),
    reach: Math.round(number("reach", REACH)),
    spacing,
    seed: given.matching("seed", isSeed, BEGINNING.seed),
    profile: given.matching("profile", (value) => PROFILES.includes(value), BEGINNING.profile),
    /** Whether the address says nothing of the view. */
    isPlain: !given.has("at"),
  };
  const outside = "The place in the address is out of reach. Here is the beginning instead.";
  return { ...state, wrong: [isNear ? null : outside, given.wrong()].filter(Boolean).join(" ") || null };
}

/** The address of a state. */
export function toHash({ at, yaw, pitch, away, reach, spacing, seed, profile }) {
  const degrees = (angle) => String(Math.round((angle * 180) / Math.PI) % 360);
  const decimals = Math.max(0, Math.ceil(2 - Math.log10(Number(spacing))));
  return hashOf([
    ["at", at.map((one) => formatPlace(one, decimals)).join(",")], ["yaw", degrees(yaw)], ["pitch", degrees(pitch)],
    ["away", Number(away.toFixed(1))], ["reach", reach], ["spacing", spacing], ["seed", seed],
    ...(profile === "blue" ? [] : [["profile", profile]]),
  ]);
}
