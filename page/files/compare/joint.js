// The view that all panels share, and what of the page stands in its address.

import { decimalsFor, formatPlace, parsePlace, place, toNumber } from "../place.js";
import { Moving } from "../view.js";

/** The fewest and the most mean spacings along the shorter side of a panel. */
const LEAST_SPAN = 4;
const MOST_SPAN = 150;
const SPAN = 32;
const NARROW_SPAN = 20;
/** Farther out, doubles do not tell places within a spacing apart. */
export const FARTHEST = 1e12;

/** The first state, before anything is chosen: `isNarrow` on phones. */
function initial(isNarrow) {
  return { x: place(0), y: place(0), span: isNarrow ? NARROW_SPAN : SPAN, seed: 1, profile: "blue" };
}

const bounded = (span) => Math.min(MOST_SPAN, Math.max(LEAST_SPAN, span));
const isNear = (at) => at && Math.abs(toNumber(at)) <= FARTHEST;

/** Reads the hash; what it does not say, or says wrongly, stays at its default. */
export function fromHash(hash, isNarrow) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const state = initial(isNarrow);
  const [x, y] = (given.get("at") ?? "").split(",").map(parsePlace);
  if (isNear(x) && isNear(y)) Object.assign(state, { x, y });
  const span = Number(given.get("span"));
  if (span > 0) state.span = bounded(span);
  const seed = given.get("seed") ?? "";
  if (/^\d{1,9}$/.test(seed)) state.seed = Number(seed);
  const profile = given.get("profile") ?? "";
  if (/^[\w.-]{1,64}$/.test(profile)) state.profile = profile;
  return state;
}

/** Writes the hash. */
export function toHash(state) {
  const at = [state.x, state.y].map((v) => formatPlace(v, decimalsFor(state.span) + 3)).join(",");
  const said = [`at=${at}`, `span=${Number(state.span.toPrecision(5))}`, `seed=${state.seed}`];
  if (state.profile !== "blue") said.push(`profile=${encodeURIComponent(state.profile)}`);
  return `#${said.join("&")}`;
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
