// The page Compare: one view for all methods, and what each measures there.

import { givenIn, hashOf } from "../address.js";
import { askJson } from "../api.js";
import { topOf } from "../charts.js";
import { byId, framed, settled, skipLinks } from "../dom.js";
import { jumps, moveBy, tools } from "../gestures.js";
import { setOptions } from "../form.js";
import { Notice } from "../notice.js";
import { decimalsFor, formatPlace, place, toNumber } from "../place.js";
import { profileNames } from "../profiles.js";
import { Moving } from "../view.js";
import { METHODS } from "./methods.js";
import { Panel } from "./panel.js";

/** The fewest and the most mean spacings along the shorter side of a panel. */
const LEAST_SPAN = 4;
const MOST_SPAN = 150;
const SPAN = 32;
const NARROW_SPAN = 20;
/** Farther out, doubles do not tell places within a spacing apart. */
const FARTHEST = 1e12;
/** Where the page begins, and where its button leads: a billion units to the right and up. */
const FAR = 1e9;

const bounded = (span) => Math.min(MOST_SPAN, Math.max(LEAST_SPAN, span));
const isNear = (at) => Math.abs(toNumber(at)) <= FARTHEST;

/** Reads the hash; what it does not say, or says wrongly, stays at its default: `isNarrow` on phones. */
function fromHash(hash, isNarrow) {
  const given = givenIn(hash);
  const [x, y] = given.at();
  const span = given.number("span", isNarrow ? NARROW_SPAN : SPAN, [Number.MIN_VALUE, Infinity]);
  const isPlace = x && y && isNear(x) && isNear(y);
  return {
    ...(isPlace ? { x, y } : { x: place(FAR), y: place(FAR) }),
    span: bounded(span),
    seed: Number(given.matching("seed", (text) => /^\d{1,9}$/.test(text), "1")),
    profile: given.matching("profile", (text) => /^[\w.-]{1,64}$/.test(text), "blue"),
    wrong: given.wrong(),
  };
}

/** Writes the hash. */
function toHash({ x, y, span, seed, profile }) {
  const at = [x, y].map((v) => formatPlace(v, decimalsFor(span) + 3)).join(",");
  return hashOf([["at", at], ["span", Number(span.toPrecision(5))], ["seed", seed], ...(profile === "blue" ? [] : [["profile", profile]])]);
}

/** One view for all panels; `moved()` hears of every move. */
class Joint extends Moving {
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

const root = document.documentElement;
const narrow = matchMedia("(max-width: 46rem)");
let state = fromHash(location.hash, narrow.matches);

const joint = new Joint(state, () => draw());
const panels = METHODS.map((method) => new Panel(method, { changed: () => draw(), failed: (error) => notice.refused(error) }));
const notice = new Notice(byId("banner"), () => {
  for (const { source } of panels) source.chunks.retry();
  begin();
}, () => begin());
const say = (words) => notice.say("wrong", words);

const paint = framed(() => {
  for (const panel of panels) panel.draw(joint.view);
  const { x, y } = joint.view;
  byId("far").textContent = isFar() ? "Back to the origin" : "A billion units away";
  const now = `${x.i + x.f},${y.i + y.f}`;
  if (now !== root.dataset.at) again();
  root.dataset.at = now;
});
const isFar = () => Math.abs(joint.view.x.i) > FAR / 2;

function draw() {
  write();
  paint();
}

const write = settled(250, () => {
  const hash = toHash(state);
  if (hash !== location.hash) history.replaceState(null, "", hash);
});

let turn = 0;

/** Measures all that is shown, one after another. */
async function measureAll() {
  // A view may settle before it is known which profiles there are.
  if (!panels.every(({ isReady }) => isReady)) return;
  turn += 1;
  const mine = turn;
  const isLatest = () => mine === turn;
  const at = { x: joint.view.x, y: joint.view.y };
  let isWhole = true;
  for (const panel of panels) {
    try {
      if (isLatest()) await panel.measure(at, isLatest);
      if (isLatest()) chart();
    } catch (error) {
      // The others do without the server.
      isWhole = false;
      if (isLatest()) notice.refused(error);
    }
  }
  if (isWhole && isLatest()) root.dataset.measured = `${root.dataset.at} ${state.seed}`;
}

/** Draws what is measured by now, all curves to the same power. */
function chart() {
  const all = panels.filter(({ curve }) => curve !== undefined);
  const top = topOf(...all.map(({ curve }) => curve));
  for (const panel of all) panel.chart(top, panels[0].curve);
}

const again = settled(300, measureAll);

/** Takes another seed or profile. */
function choose(change) {
  Object.assign(state, change);
  show();
}

function show() {
  root.dataset.measured = "";
  for (const panel of panels) panel.use(state);
  if (byId("seed").value !== String(state.seed)) byId("seed").value = String(state.seed);
  byId("profile").value = state.profile;
  resize();
  again();
}

function resize() {
  const { clientWidth, clientHeight } = panels[0].plane;
  if (clientWidth && clientHeight) joint.resize(clientWidth, clientHeight);
}

function home() {
  byId("jump-at").value = "";
  joint.lookAt(place(0), place(0));
}

addEventListener("hashchange", () => {
  state = Object.assign(joint.state, fromHash(location.hash, narrow.matches));
  joint.lookAt(state.x, state.y, state.span);
  show();
});

async function begin() {
  try {
    const { profiles } = await askJson("/v1/profiles");
    const names = profileNames(profiles);
    if (!names.includes(state.profile)) {
      if (location.hash.includes("profile=")) say(`This server has no profile “${state.profile}”.`);
      [state.profile] = names.includes("blue") ? ["blue"] : names;
    }
    setOptions(byId("profile"), names, state.profile);
  } catch (error) {
    notice.refused(error);
  }
  show();
}

say(state.wrong);
// For tests.
globalThis.strew = { joint, panels };
byId("methods").append(...panels.map(({ element }) => element));
for (const { plane } of panels) {
  moveBy(plane, joint, { tapped: () => {}, hovered: () => {} });
  new ResizeObserver(resize).observe(plane);
}
tools(joint, home, () => {
  for (const panel of panels) panel.themed();
  chart();
  draw();
});
jumps(say, ({ x, y }) => {
  if (!isNear(x) || !isNear(y)) return "is too far out: this page ends 1e12 from the origin.";
  joint.lookAt(x, y);
  return null;
});
byId("far").addEventListener("click", () => (isFar() ? home() : joint.lookAt(place(FAR), place(FAR))));
const [field, profile] = [byId("seed"), byId("profile")];
field.addEventListener("change", () => {
  const seed = Number(field.value);
  const isSeed = Number.isInteger(seed) && seed >= 0 && seed < 1e9;
  field.setAttribute("aria-invalid", String(!isSeed));
  say(isSeed ? null : "The seed must be a whole number from 0 to 999,999,999.");
  if (isSeed) choose({ seed });
});
profile.addEventListener("change", () => choose({ profile: profile.value }));
skipLinks();
begin();
