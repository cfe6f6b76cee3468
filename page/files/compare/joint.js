// The view that all panels share, and what of the page stands in its address.

import { givenIn, hashOf } from "../address.js";
import { decimalsFor, formatPlace, place, toNumber } from "../place.js";
import { Moving } from "../view.js";

/** The fewest and the most mean spacings along the shorter side of a panel. */
const LEAST_SPAN = 4;
const MOST_SPAN = 150;
const SPAN = 32;
const NARROW_SPAN = 20;
/** Farther out, doubles do not tell places within a spacing apart. */
export const FARTHEST = 1e12;
/** Where the page begins, and where its button leads: a billion units to the right and up. */
export const FAR = 1e9;

const bounded = (span) => Math.min(MOST_SPAN, Math.max(LEAST_SPAN, span));
const isNear = (at) => Math.abs(toNumber(at)) <= FARTHEST;

/** Reads the hash; what it does not say, or says wrongly, stays at its default: `isNarrow` on phones. */
export function fromHash(hash, isNarrow) {
  const given = givenIn(hash);
  const [x, y] = given.at();
  const span = given.number("span", isNarrow ? NARROW_SPAN : SPAN, [Number.MIN_VALUE, Infinity]);
  const isPlace = x && y && isNear(x) && isNear(y);
  return {
    ...(isPlace ? { x, y } : { x: place(FAR), y: place(FAR) }),
    span: bounded(span),
    seed: Number(given.matching("seed", /^\d{1,9}$/, "1")),
    profile: given.matching("profile", /^[\w.-]{1,64}$/, "blue"),
    wrong: given.wrong(),
  };
}

/** Writes the hash. */
export function toHash({ x, y, span, seed, profile }) {
  const at = [x, y].map((v) => formatPlace(v, decimalsFor(span) + 3)).join(",");
  return hashOf([["at", at], ["span", Number(span.toPrecision(5))], ["seed", seed], ...(profile === "blue" ? [] : [["profile", profile]])]);
}

/** One view for all panels; `moved()` hears of every move. */
export class Joint extends Moving {
  constructor(state, moved) {
    super();
    this.state = state;
    this.moved = moved;
    Object.assign(this.view, { x: state.x, y: state.y });
    this.span = state.span;
  }

  bounded(span) {
    return bounded(span);
  }

  within(at) {
    return isNear(at) ? at : place(Math.sign(toNumber(at)) * FARTHEST);
  }

  changed() {
    const { view: { x, y }, span } = this;
    Object.assign(this.state, { x, y, span });
    this.moved();
  }
}
