// The page: puts its parts together.

import { Gone, Problem, askJson, onPresence, wordsOf } from "./api.js";
import { Card } from "./card.js";
import { Controls } from "./controls.js";
import { byId, icon, settled, skipLinks, spoken } from "./dom.js";
import { faultsOf, faultsBefore } from "./faults.js";
import { openFlight } from "./flight.js";
import { Gallery } from "./gallery.js";
import { jumps, moveBy, tools } from "./gestures.js";
import { farthest, isTooFar } from "./grid.js";
import { place, toNumber } from "./place.js";
import { sendPicture, takeDrops } from "./sent.js";
import { Notice } from "./notice.js";
import { Plane } from "./plane.js";
import { Pour } from "./pour.js";
import { PROFILE_WORDS, profileNames } from "./profiles.js";
import { Session } from "./session.js";
import { Shade } from "./shade.js";
import { Status } from "./status.js";
import { LAYER, initial } from "./state.js";
import { Start } from "./start.js";
import { Tabs } from "./tabs.js";
import { Take } from "./take.js";
import { Paint } from "./paint/paint.js";
import { palette } from "./theme.js";
import { Understand } from "./understand.js";

const root = document.documentElement;
/** Whether the visitor comes without a link to a view. */
const isFirst = "first" in root.dataset;
const session = new Session();

/**
 * The parts of the page. Each hears of what it has a method for: `moved()` by hand or by a choice; `rested()`, all in view is
 * painted; `shown(layers, understood)`, which the server has understood; `themed()`; `opened(tab)`; and where the plane
 * was `tapped(at)` or is `hovered(at)`, in CSS pixels from the corner at the top left, `null` where the mouse has left.
 * @type {any[]}
 */
const parts = [];
const tell = (/** @type {string} */ event, /** @type {any[]} */ ...given) => parts.forEach((part) => part[event]?.(...given));

const plane = new Plane(byId("plane"), {
  moved: () => {
    // Before the server has said what a spacing is, nothing is looked at.
    if (!plane.span) return;
    session.viewed(plane.view, plane.span);
    loading();
    status.moved();
    if (plane.chunks.refused && isUnderstood) again();
    tell("moved");
  },
  progress: (share) => {
    const bar = byId("progress");
    bar.hidden = share >= 1;
    if (share > 0 && plane.chunks.wanted.length > 0) arrived();
    bar.setAttribute("aria-valuenow", String(Math.round(share * 100)));
    /** @type {HTMLElement} */ (bar.firstElementChild).style.transform = `scaleX(${share})`;
    shade.painted();
  },
  settled: () => {
    if (root.dataset.state === "loading" && isUnderstood) root.dataset.state = "ready";
    rested();
  },
  failed: (error) => {
    // Faults of the query are shown at its fields.
    if (!isUnderstood) return;
    root.dataset.state = "failed";
    const isTooMuch = error instanceof Problem && error.status === 413;
    if (!isTooMuch) return notice.say("refused", "The server does not send these points.", { note: error.message });
    notice.say("refused", "There are more points in this view than the server sends at once. Zoom in, or choose fewer points.", {
      buttons: [["Zoom in", () => plane.zoom(2)], ["Try again", retry]],
    });
  },
});

/** Requests everything again that was refused or put off. */
function retry() {
  notice.clear();
  plane.chunks.retry();
  if (!isUnderstood) (controls ? refresh : begin)();
  else loading();
  plane.draw();
}

/** A view beside one that was refused may be answered. */
const again = settled(300, () => {
  if (plane.chunks.refused && isUnderstood) retry();
});

/** Points are awaited. */
function loading() {
  root.dataset.state = "loading";
  notice.watch();
}

/** Whether an answer is awaited that the points depend on. */
let isAsking = false;

/** When something is done again. */
let timer = 0;

/** Does something again later, because the server is busy; `error` says how much later. */
function later(error, what) {
  const wait = Math.max(1, error.retryAfter) * 1000;
  notice.busy(performance.now() + wait);
  clearTimeout(timer);
  timer = setTimeout(what, wait);
}

/** Points are there: the plane, hidden until then, is seen. */
function shownFirst() {
  if ("shown" in root.dataset) return;
  root.dataset.shown = "";
  performance.mark("points");
}

/** Points have come: on a first visit they pour into place. */
function arrived() {
  shownFirst();
  if (isFirst && !("first" in root.dataset || "pour" in root.dataset)) pour.begin(matchMedia("(prefers-reduced-motion: reduce)").matches);
}

const status = new Status(session, plane);
const pour = new Pour(plane);
const rested = settled(250, () => {
  tell("rested");
  if (session.state.layers.length > 1) controls?.counted(countsInView());
});

/** The number of points of each layer in view. */
function countsInView() {
  const counts = session.state.layers.map(() => 0);
  plane.each((layer) => (counts[layer] += 1));
  return counts;
}

const notice = new Notice(byId("banner"), retry, () => {
  controls ? refresh() : begin();
  status.moved();
});
notice.awaited = { chunks: plane.chunks, isAsking: () => isAsking };
const say = (/** @type {string | null} */ words) => notice.say("wrong", words);
onPresence((gone) => (root.dataset.presence = gone ? "gone" : "here"));

let latest = 0;
/** Whether the server has resolved the layers; before, they are shown as the page understands them. */
let isUnderstood = false;
/** The message to show with the plane, if it does not show what was requested: the reason. */
let news = session.state.wrong;

/** The server's resolved values of each layer, or its faults. */
async function notesOf(layers) {
  const notes = await Promise.all(layers.map(async (layer, i) => {
    try {
      const faults = faultsBefore(layer, i);
      if (Object.keys(faults).length > 0) return { faults };
      return { understood: await session.understand(layer) };
    } catch (error) {
      return { faults: faultsOf(error), error };
    }
  }));
  // Layers that are right one by one can still be wrong together.
  if (notes.every((note) => note.understood)) {
    const wrong = await session.understandTogether(layers);
    if (wrong) notes[wrong.layer] = { faults: faultsOf(wrong.error), error: wrong.error };
  }
  return notes;
}

/** Has the server understand the layers, then shows them. `isChosen`: the visitor changed them just now. */
async function refresh(isChosen = false) {
  latest += 1;
  const mine = latest;
  clearTimeout(timer);
  isAsking = true;
  notice.watch();
  const lacking = await session.settleWorld().then(() => null, (error) => error);
  const layers = session.state.layers.map((layer) => ({ ...layer }));
  const notes = lacking ? [{ faults: { "": worldFault(lacking) }, error: lacking }] : await notesOf(layers);
  if (mine !== latest) return;
  const passing = notes.map((note) => note.error).find((error) => error?.isPassing);
  if (passing) return later(passing, () => refresh(isChosen));
  isAsking = false;
  notice.clear();
  controls?.note(notes);
  const errors = notes.map((note) => note.error).filter(Boolean);
  if (errors.some((error) => error instanceof Gone)) return;
  const locked = errors.find((error) => error.isLocked);
  if (locked) return refused(locked);
  if (notes.some((note) => note.faults)) {
    isUnderstood = false;
    root.dataset.state = "failed";
    status.refused();
    sayFaults(notes, isChosen);
    return;
  }
  isUnderstood = true;
  show(layers, notes.map((note) => note.understood), isChosen);
}

/** Whether the fields of layers are in sight. */
const isChoosing = () => ["choose", "understand"].includes(session.state.tab);

/** Says what is wrong with layers: at the fields if they were just changed, over the plane if a link leads here. */
function sayFaults(notes, isChosen) {
  const other = notes.map((note) => note.faults?.[""]).find(Boolean);
  const wrong = notes.findIndex((note) => note.faults);
  const isSeen = wrong === controls?.picked && isChoosing();
  const words = other ?? Object.values(notes[wrong].faults)[0];
  const named = notes.length > 1 ? `Layer ${wrong + 1}: ${words}` : words;
  if (isChosen && isSeen && !other) return;
  if (isChosen) return notice.say("wrong", named, { buttons: other ? [["Try again", () => refresh()]] : [["Show it", () => pointOut(wrong)]] });
  /** @type {import("./notice.js").Buttons} */
  const buttons = [["Begin afresh", afresh]];
  if (!other) buttons.unshift(["Show the field", () => pointOut(wrong)]);
  notice.say("refused", "This link leads to points that cannot be drawn.", { note: named, buttons });
}

/** Why a world cannot be shown, in the page's words. */
function worldFault(error) {
  return error.faults?.some(({ field }) => field === "world") ? `This server has no world “${session.state.world}”.` : error.message;
}

/** Begins with what a visitor sees who comes without a link. */
function afresh() {
  notice.clear();
  session.choose((state) => Object.assign(state, initial()), "layers", "view", "tab");
}

/** Shows the fields of a layer that something is wrong with. */
function pointOut(layer) {
  say(null);
  controls?.pick(layer);
  if (!isChoosing()) session.choose((state) => (state.tab = "choose"), "tab");
  byId("choose").querySelector('[aria-invalid="true"]')?.focus();
}

/** Shows layers that the server has understood. */
function show(layers, understood, isChosen) {
  const spacings = understood.map((one) => one.spacing);
  const nearest = Math.min(...spacings);
  const before = plane.look?.spacing ?? nearest;
  if (isTooFar(session.state, nearest)) goBack(nearest);
  say(news);
  news = null;
  loading();
  shownFirst();
  plane.show({ layers, spacings, ...palette(layers) });
  const across = session.state.span / nearest;
  // A choice that leaves no point in view, or too many to tell apart, takes the view along.
  if (isChosen && (across < 4 || across > 2000)) session.state.span *= nearest / before;
  const { x, y, span } = session.state;
  plane.lookAt(x, y, span);
  plane.chunks.retry();
  tell("shown", layers, understood);
}

/** From where there are no points to the place that was looked at before, or to the origin. */
function goBack(spacing) {
  const { x, y } = session.state;
  const words = `${spoken(toNumber(x), 4)}, ${spoken(toNumber(y), 4)}`;
  const isOnPlane = plane.span && !isTooFar(plane.view, spacing);
  const [to, name] = isOnPlane ? [plane.view, "the place before"] : [{ x: place(0), y: place(0) }, "the origin"];
  session.correct((state) => Object.assign(state, { x: to.x, y: to.y }));
  news = `${words} ${farOut(spacing)} Here is ${name} instead.`;
}

/** What is said of a place without points. */
const farOut = (/** @type {number} */ spacing) => `is too far out: at this spacing, coordinates tell points apart only up to ${spoken(farthest(spacing), 3)} from the origin.`;

function jump(at) {
  if (plane.isTooFar(at)) return farOut(plane.look?.spacing ?? 1);
  session.choose((state) => Object.assign(state, at), "view");
  byId("plane").focus();
  return null;
}

const ICONS = {
  share: "M10 14a4.5 4.5 0 0 0 6.4 0l3-3a4.5 4.5 0 0 0-6.4-6.4l-1 1M14 10a4.5 4.5 0 0 0-6.4 0l-3 3a4.5 4.5 0 0 0 6.4 6.4l1-1",
  fold: "M6 15l6-6 6 6",
};

/** Copies the address of the view. */
async function share() {
  session.save();
  let words = "The link is copied.";
  try {
    await navigator.clipboard.writeText(location.href);
  } catch {
    words = "The link is in the address bar of your browser: the browser does not let this page copy it.";
  }
  mention(words);
}

const forget = settled(6000, () => (byId("caption").hidden = true));

/** Says something at the bottom of the plane for a while. */
function mention(words) {
  byId("said").textContent = words;
  byId("caption").textContent = words;
  byId("caption").hidden = false;
  forget();
}

function fold(isFolded) {
  byId("panel").classList.toggle("folded", isFolded);
  byId("fold").setAttribute("aria-expanded", String(!isFolded));
}

/** @type {Controls | null} */
let controls = null;
/** The tables of the server. */
let tables = [];

const [understand, take] = [new Understand(session, plane), new Take(session, plane)];
const shade = new Shade(plane);
const card = new Card(session, plane);
const paint = new Paint(session, plane, {
  picked: () => controls?.picked ?? 0,
  say,
});
const start = new Start(session, () => {
  fold(matchMedia("(max-width: 46rem)").matches);
  byId("plane").focus();
}, mention);
parts.push(pour, start, card, understand, take, shade, paint);
for (const [id, path] of Object.entries(ICONS)) byId(id).append(icon(path));
jumps(say, jump);
byId("brand").addEventListener("click", (event) => {
  event.preventDefault();
  afresh();
});
byId("share").addEventListener("click", share);
byId("fold").addEventListener("click", () => fold(byId("fold").getAttribute("aria-expanded") === "true"));
const home = () => {
  byId("jump-at").value = "";
  byId("jump-at").removeAttribute("aria-invalid");
  session.choose((state) => Object.assign(state, { x: place(0), y: place(0), span: initial().span * (plane.look?.spacing ?? 1) }), "view");
};
tools(plane, home, () => {
  if (plane.look) plane.show({ ...plane.look, ...palette(plane.look.layers) });
  tell("themed");
});
skipLinks();
takeDrops(byId("stage"), stipple);
const tabs = new Tabs(session, fold, (tab) => tell("opened", tab));
moveBy(byId("plane"), plane, {
  tapped: (at) => tell("tapped", at),
  hovered: (at) => tell("hovered", at),
});
session.on((changed) => {
  if (changed.has("layers")) settle(tables);
  if (changed.has("layers")) refresh(!changed.has("view"));
  else if (changed.has("view")) plane.lookAt(session.state.x, session.state.y, session.state.span);
  if (changed.has("tab")) tabs.show();
});

/** Stipples a picture with the layer that is picked. */
async function stipple(file) {
  if (!controls) return;
  try {
    notice.say("wrong", `Sending “${file.name}” …`, { buttons: [] });
    const members = await sendPicture(file, plane.view);
    say(null);
    session.leaveWorld();
    controls.change(members);
  } catch (error) {
    say(wordsOf(error));
  }
}

/** Profiles that this server does not have are replaced by the one to begin with, or by its first one. */
function settle(profiles) {
  const names = profileNames(profiles);
  if (names.length === 0) return;
  const standard = names.includes(LAYER.profile) ? LAYER.profile : names[0];
  const missing = [...new Set(session.state.layers.map((layer) => layer.profile).filter((name) => !names.includes(name)))];
  if (missing.length === 0) return;
  const wasChosen = missing.some((name) => name !== LAYER.profile);
  if (wasChosen) news = `This server has no profile “${missing.join("”, “")}”. Here is “${standard}” instead.`;
  session.correct((state) => {
    for (const layer of state.layers) {
      if (missing.includes(layer.profile)) Object.assign(layer, { profile: standard, alpha: "", map: "" });
    }
  });
}

/** Shows the layers before the server has said anything, where their spacings need no server. */
function beginEarly() {
  const { layers, x, y, span, world } = session.state;
  if (world) return;
  const spacings = layers.map(spacingOf);
  // What a server may not have is looked up first.
  if (!layers.every(({ profile, alpha, map }) => profile in PROFILE_WORDS && !alpha && !map)) return;
  if (!spacings.every((spacing) => spacing > 1e-100 && spacing < 1e100) || isTooFar(session.state, Math.min(...spacings))) return;
  plane.show({ layers: layers.map((layer) => ({ ...layer })), spacings, ...palette(layers) });
  plane.lookAt(x, y, span);
  notesOf(layers).catch(() => {});
}

/** The mean spacing of a layer, as far as it follows from its own words. */
function spacingOf({ by, amount }) {
  return by === "spacing" ? Number(amount) : by === "density" ? Number(amount) ** -0.5 : NaN;
}

/** Says what the server refused, which may want a key: nothing is flown over then. */
function refused(error) {
  if (error instanceof Problem) byId("flight").close();
  notice.refused(error);
}

/** Begins: first with points, then with what the server has to choose from. */
async function begin() {
  try {
    isAsking = true;
    notice.watch();
    if (!plane.span) beginEarly();
    const [{ profiles }, { fields }, { worlds }] = await Promise.all([askJson("/v1/profiles"), askJson("/v1/fields"), askJson("/v1/worlds")]);
    settle(profiles);
    tables = profiles;
    controls = new Controls(session, { profiles, fields, worlds }, stipple);
    const gallery = new Gallery(session, profiles);
    Object.assign(globalThis.strew, { gallery, controls });
    parts.push(gallery);
    gallery.opened(session.state.tab);
    await refresh();
  } catch (error) {
    if (error instanceof Problem && error.isPassing) return later(error, begin);
    refused(error);
  }
}

if (isFirst) openFlight(() => plane.look && arrived());
// For the curious, and for tests.
globalThis.strew = { plane, pour, start, card, shade, stipple, session, status, understand, take, paint };
begin();
