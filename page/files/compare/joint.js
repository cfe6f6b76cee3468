// The view that all panels share, and what of the page stands in its address.

import { decimalsFor, formatPlace, moved, parsePlace, place, toNumber } from "../place.js";
import { METHODS, methodOf } from "./methods.js";

/** The fewest and the most mean spacings along the shorter side of a panel. */
const LEAST_SPAN = 4;
const MOST_SPAN = 150;
const SPAN = 32;
const NARROW_SPAN = 20;
/** Farther out, doubles do not tell places within a spacing apart. */
export const FARTHEST = 1e12;
/** The methods that are shown at first. */
export const PAIR = ["strew", "poisson"];

/** The first state, before anything is chosen: `isNarrow` on phones. */
function initial(isNarrow) {
  return { x: place(0), y: place(0), span: isNarrow ? NARROW_SPAN : SPAN, seed: 1, profile: "blue", shown: [...PAIR] };
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
  const shown = (given.get("show") ?? "").split(",").filter(methodOf);
  if (shown.length > 0) state.shown = METHODS.map(({ id }) => id).filter((id) => shown.includes(id));
  return state;
}

/** Writes the hash. */
export function toHash(state) {
  const at = [state.x, state.y].map((v) => formatPlace(v, decimalsFor(state.span) + 3)).join(",");
  const said = [`at=${at}`, `span=${Number(state.span.toPrecision(5))}`, `seed=${state.seed}`];
  if (state.profile !== "blue") said.push(`profile=${encodeURIComponent(state.profile)}`);
  said.push(`show=${state.shown.join(",")}`);
  return `#${said.join("&")}`;
}

/** One view for all panels; `changed()` hears of every move. */
export class Joint {
  /** `within(span)` is a span that can be shown. */
  constructor(state, changed, within = bounded) {
    this.bounded = within;
    this.state = state;
    this.changed = changed;
    this.view = { x: state.x, y: state.y, unit: 1, width: 1, height: 1, ratio: 1, pixels: [1, 1] };
  }

  /** Takes the size of the panels, in CSS pixels. */
  resize(width, height) {
    const ratio = Math.min(2, globalThis.devicePixelRatio || 1);
    const pixels = [Math.round(width * ratio), Math.round(height * ratio)];
    Object.assign(this.view, { width, height, ratio, pixels });
    this.lookAt(this.view.x, this.view.y);
  }

  lookAt(x, y, span = this.state.span) {
    const { view, state } = this;
    if (isNear(x) && isNear(y)) Object.assign(view, { x, y });
    state.span = this.bounded(span);
    view.unit = state.span / Math.min(view.width, view.height);
    Object.assign(state, { x: view.x, y: view.y });
    this.changed();
  }

  /** Moves by CSS pixels, as a hand moves a sheet. */
  drag(dx, dy) {
    const { view } = this;
    this.lookAt(moved(view.x, -dx * view.unit), moved(view.y, dy * view.unit));
  }

  /** Enlarges by a factor about a place on a panel, in CSS pixels. */
  zoom(factor, at = [this.view.width / 2, this.view.height / 2]) {
    const { view, state } = this;
    const span = this.bounded(state.span / factor);
    const grown = view.unit * (1 - span / state.span);
    const [dx, dy] = [at[0] - view.width / 2, view.height / 2 - at[1]];
    this.lookAt(moved(view.x, dx * grown), moved(view.y, dy * grown), span);
  }
}
