// The page Compare: one view for all methods, and what each measures there.

import { Gone, askJson, isAway, onPresence } from "../api.js";
import { tools } from "../bar.js";
import { topOf } from "../charts.js";
import { byId, make, settled, skipLinks } from "../dom.js";
import { refusal } from "../form.js";
import { moveBy } from "../gestures.js";
import { parsePlace, place } from "../place.js";
import { FARTHEST, Joint, PAIR, fromHash, toHash } from "./joint.js";
import { METHODS } from "./methods.js";
import { Panel } from "./panel.js";
import { Asked, windowAround } from "./sources.js";

/** Where the button leads: a billion units to the right and up. */
const FAR = 1e9;
/** Units along the shorter side where a window is shown alone: the regions of the methods that have one fit. */
const ALONE = 290;

const root = document.documentElement;
const narrow = matchMedia("(max-width: 46rem)");
let state = fromHash(location.hash, narrow.matches);

const joint = new Joint(state, () => draw());
const panels = METHODS.map((method) => new Panel(method, { changed: () => draw(), failed: (error) => refused(error) }));
const shown = () => panels.filter(({ method }) => state.shown.includes(method.id));

/** Says something above the panels; `null` takes it away. That the server is away stays until it is back. */
function say(words) {
  const all = [isAway() && AWAY, words].filter(Boolean).join(" ");
  byId("banner").hidden = all === "";
  byId("banner").textContent = all;
}

const AWAY = "The server does not answer. This page tries again by itself; what is drawn stays, and the other methods are made here.";

/** Says what went wrong, and takes a key where that is what the server needs; that it is away is said by itself. */
function refused(error) {
  if (error instanceof Gone) return;
  refusal(byId("banner"), error, () => {
    for (const { source } of panels) if (source instanceof Asked) source.chunks.retry();
    begin();
  });
}

let isWaiting = false;
/**
 * The window that is shown alone, with the scale it is shown at and the view it was taken from; `null` if none is.
 * @type {{ window: ReturnType<typeof windowAround>, unit: number, key: string } | null}
 */
let alone = null;
const keyOf = ({ x, y, unit, width, height }) => [x.i, x.f, y.i, y.f, unit, width, height].join();

/** Shows what has to be made for the window alone, and nothing else; or all points again. */
function showAlone(isAlone) {
  const { view } = joint;
  const unit = Math.max(ALONE, 1.5 * state.span) / Math.min(view.width, view.height);
  alone = isAlone ? { window: windowAround(view, view.width * view.unit, view.height * view.unit), unit, key: keyOf(view) } : null;
  byId("alone").setAttribute("aria-pressed", String(isAlone));
  byId("said").textContent = isAlone
    ? "The frame is the window, from farther away. Only what has to be made to show it is drawn."
    : TRY;
  draw();
}

const TRY = "What does a method have to make before it can show this window?";

function draw() {
  write();
  if (isWaiting) return;
  isWaiting = true;
  requestAnimationFrame(() => {
    isWaiting = false;
    // Who moves the view wants to see all points.
    if (alone && alone.key !== keyOf(joint.view)) showAlone(false);
    for (const panel of shown()) panel.draw(joint.view, alone);
    const { x, y } = joint.view;
    const isFar = Math.abs(x.i) > FAR / 2;
    byId("far").textContent = isFar ? "Back to the origin" : "A billion units away";
    const now = `${x.i + x.f},${y.i + y.f}`;
    if (now !== root.dataset.at) again();
    root.dataset.at = now;
  });
}

const write = settled(250, () => {
  const hash = toHash(state);
  if (hash !== location.hash) history.replaceState(null, "", hash);
});

let turn = 0;

/** Measures all that is shown, one after another, then how long points take. */
async function measureAll() {
  // A view may settle before it is known which profiles there are.
  if (!shown().every(({ isReady }) => isReady)) return;
  turn += 1;
  const mine = turn;
  const isLatest = () => mine === turn;
  const at = { x: joint.view.x, y: joint.view.y };
  const each = async (act) => {
    let isWhole = true;
    for (const panel of shown()) {
      try {
        if (isLatest()) await act(panel);
      } catch (error) {
        // The others do without the server.
        isWhole = false;
        if (isLatest()) refused(error);
      }
    }
    return isWhole && isLatest();
  };
  const isMeasured = await each(async (panel) => {
    await panel.measure(at, isLatest);
    if (isLatest()) chart();
  });
  if (isMeasured) root.dataset.measured = `${root.dataset.at} ${state.seed} ${state.shown.join()}`;
  const isTimed = await each(async (panel) => {
    if (!panel.isTimed) await panel.time();
    panel.isTimed = true;
  });
  if (isTimed) root.dataset.timed = String(shown().length);
}

/** Draws what is measured by now, all curves to the same power. */
function chart() {
  const all = shown().filter(({ curve }) => curve !== undefined);
  const top = topOf(...all.map(({ curve }) => curve));
  // Strew's curve is there to compare with while Strew is shown; otherwise it may be that of another place.
  const reference = all.includes(panels[0]) ? panels[0].curve : undefined;
  for (const panel of all) panel.chart(top, reference);
}

const again = settled(300, measureAll);

/** Takes another choice of methods, seed or profile. */
function choose(change) {
  Object.assign(state, change);
  show();
}

function show() {
  root.dataset.measured = "";
  arrange();
  for (const panel of shown()) panel.use(state);
  if (byId("seed").value !== String(state.seed)) byId("seed").value = String(state.seed);
  byId("profile").value = state.profile;
  resize();
  again();
}

/** Shows the panels of the chosen methods. */
function arrange() {
  for (const { element, method } of panels) {
    const isShown = state.shown.includes(method.id);
    element.hidden = !isShown;
    byId(`show-${method.id}`).setAttribute("aria-pressed", String(isShown));
  }
  byId("methods").dataset.count = String(state.shown.length);
  byId("all").setAttribute("aria-pressed", String(state.shown.length === METHODS.length));
  byId("show").hidden = state.shown.join() === PAIR.join();
}

function resize() {
  const { clientWidth, clientHeight } = shown()[0].plane;
  if (clientWidth && clientHeight) joint.resize(clientWidth, clientHeight);
}

function pick(id) {
  const without = state.shown.filter((one) => one !== id);
  if (without.length === 0) return;
  const isShown = without.length < state.shown.length;
  choose({ shown: isShown ? without : METHODS.map((one) => one.id).filter((one) => one === id || without.includes(one)) });
}

function jump(event) {
  event.preventDefault();
  const field = byId("jump-at");
  const [x, y] = field.value.split(/[,;]|\s+/).filter(Boolean).map(parsePlace);
  const isPlace = x && y && Math.abs(x.i) <= FARTHEST && Math.abs(y.i) <= FARTHEST;
  field.setAttribute("aria-invalid", String(!isPlace));
  say(isPlace ? null : `“${field.value}” is not a place here. Enter two numbers from −1e12 to 1e12, such as 1e6, -3.5.`);
  if (isPlace) joint.lookAt(x, y);
}

function home() {
  byId("jump-at").value = "";
  joint.lookAt(place(0), place(0));
}

function listen() {
  tools(joint, home, () => {
    for (const panel of shown()) panel.sheet.renew();
    chart();
    draw();
  });
  byId("jump").addEventListener("submit", jump);
  byId("alone").addEventListener("click", () => showAlone(!alone));
  byId("far").addEventListener("click", () => {
    const isFar = Math.abs(joint.view.x.i) > FAR / 2;
    if (isFar) home();
    else joint.lookAt(place(FAR), place(FAR));
  });
  byId("all").addEventListener("click", () => {
    const isAll = state.shown.length === METHODS.length;
    choose({ shown: isAll ? [...PAIR] : METHODS.map(({ id }) => id) });
  });
  const [field, profile] = [byId("seed"), byId("profile")];
  field.addEventListener("change", () => {
    const seed = Number(field.value);
    const isSeed = Number.isInteger(seed) && seed >= 0 && seed < 1e9;
    field.setAttribute("aria-invalid", String(!isSeed));
    say(isSeed ? null : "The seed must be a whole number from 0 to 999,999,999.");
    if (isSeed) reseed(seed);
  });
  profile.addEventListener("change", () => choose({ profile: profile.value }));
}

function reseed(seed) {
  for (const panel of panels) panel.isTimed = false;
  choose({ seed });
}

function build() {
  byId("show").append(...METHODS.map(({ id, name }) => make("button", { type: "button", id: `show-${id}`, onclick: () => pick(id) }, name)));
  byId("methods").append(...panels.map(({ element }) => element));
  arrange();
  for (const { plane } of panels) {
    moveBy(plane, joint, { tapped: () => {}, hovered: () => {} });
    new ResizeObserver(resize).observe(plane);
  }
}

onPresence((gone) => {
  say(null);
  if (!gone) begin();
});

addEventListener("hashchange", () => {
  state = Object.assign(joint.state, fromHash(location.hash, narrow.matches));
  joint.lookAt(state.x, state.y, state.span);
  show();
});

async function begin() {
  try {
    const { profiles } = await askJson("/v1/profiles");
    const names = [...new Set(profiles.map(({ profile }) => profile))];
    if (!names.includes(state.profile)) {
      if (location.hash.includes("profile=")) say(`This server has no profile “${state.profile}”.`);
      [state.profile] = names.includes("blue") ? ["blue"] : names;
    }
    byId("profile").replaceChildren(...names.map((name) => make("option", { value: name }, name)));
  } catch (error) {
    refused(error);
  }
  show();
}

// For tests.
globalThis.strew = { joint, panels };
build();
arrange();
byId("said").textContent = TRY;
listen();
skipLinks();
begin();
