// The page: puts its parts together.

import { Gone, askJson, onPresence } from "./api.js";
import { Card } from "./card.js";
import { Controls } from "./controls.js";
import { byId, icon, make, settled, skipLinks, spoken } from "./dom.js";
import { faultsOf, faultsBefore } from "./faults.js";
import { keyForm } from "./form.js";
import { Gallery } from "./gallery.js";
import { moveBy } from "./gestures.js";
import { farthest, isTooFar } from "./grid.js";
import { parsePlace, place, toNumber } from "./place.js";
import { sendPicture, takeDrops } from "./picture.js";
import { Plane } from "./plane.js";
import { profileNames } from "./profiles.js";
import { Session } from "./session.js";
import { Shade } from "./shade.js";
import { Status } from "./status.js";
import { LAYER, initial } from "./state.js";
import { Start } from "./start.js";
import { Take } from "./take.js";
import { Paint } from "./paint/paint.js";
import { palette, watchTheme } from "./theme.js";
import { Understand } from "./understand.js";
import { Works } from "./works/works.js";

const root = document.documentElement;
const session = new Session();

/** @type {import("./part.js").Part[]} */
const parts = [];
const plane = new Plane(byId("plane"), session.state.renderer, {
  moved: () => {
    // Before the server has said what a spacing is, nothing is looked at.
    if (!plane.span) return;
    session.viewed(plane.view, plane.span);
    root.dataset.state = "loading";
    status.moved();
    for (const part of parts) part.moved();
  },
  progress: (share) => {
    const bar = byId("progress");
    bar.hidden = share >= 1;
    if (share > 0 && plane.chunks.wanted.length > 0) shownFirst();
    bar.setAttribute("aria-valuenow", String(Math.round(share * 100)));
    /** @type {HTMLElement} */ (bar.firstElementChild).style.transform = `scaleX(${share})`;
  },
  settled: () => {
    if (root.dataset.state === "loading" && isUnderstood) root.dataset.state = "ready";
    rested();
  },
  failed: (error) => {
    // Faults of the query are shown at its fields.
    if (!isUnderstood) return;
    root.dataset.state = "failed";
    banner(error.message, [["Try again", () => {
      banner(null);
      root.dataset.state = "loading";
      plane.chunks.retry();
      plane.draw();
    }]]);
  },
});

/** Points are there: the plane, hidden until then, is seen. */
function shownFirst() {
  if ("shown" in root.dataset) return;
  root.dataset.shown = "";
  performance.mark("points");
}

const status = new Status(session, plane);
root.dataset.renderer = plane.painter.name;
const rested = settled(250, () => {
  for (const part of parts) part.rested();
  if (session.state.layers.length > 1) controls?.counted(countsInView());
});

/** The number of points of each layer in view. */
function countsInView() {
  const counts = session.state.layers.map(() => 0);
  plane.each((layer) => (counts[layer] += 1));
  return counts;
}

/** Says something above the plane, with buttons; `null` takes it away. */
function banner(words, buttons = []) {
  const element = byId("banner");
  element.hidden = words === null;
  element.replaceChildren(words ?? "", make("div", {}, buttons.map(([name, onclick]) => make("button", { type: "button", onclick }, name))));
}

onPresence((gone) => {
  root.dataset.presence = gone ? "gone" : "here";
  if (gone) banner("The server does not answer. This page tries again by itself; what is drawn stays.");
  else {
    banner(null);
    if (controls) refresh();
    status.moved();
  }
});

let latest = 0;
/** Whether the server has resolved the layers; before, they are shown as the page understands them. */
let isUnderstood = false;
/** The message to show with the plane, if it does not show what was requested: the reason. */
let notice = /** @type {string | null} */ (null);

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
  const layers = session.state.layers.map((layer) => ({ ...layer }));
  const notes = await notesOf(layers);
  if (mine !== latest) return;
  controls?.note(notes);
  const errors = notes.map((note) => note.error).filter(Boolean);
  if (errors.some((error) => error instanceof Gone)) return;
  const locked = errors.find((error) => error.isLocked);
  if (locked) return askForKey();
  if (notes.some((note) => note.faults)) {
    isUnderstood = false;
    root.dataset.state = "failed";
    status.refused();
    const other = notes.map((note) => note.faults?.[""]).find(Boolean);
    const unseen = notes.findIndex((note, i) => note.faults && (i !== controls?.picked || session.state.tab !== "choose"));
    if (other) banner(other, [["Try again", () => refresh()]]);
    else if (unseen >= 0) banner(`Layer ${unseen + 1}: ${Object.values(notes[unseen].faults)[0]}`, [["Show it", () => pointOut(unseen)]]);
    return;
  }
  isUnderstood = true;
  show(layers, notes.map((note) => note.understood), isChosen);
}

/** Shows the fields of a layer that something is wrong with. */
function pointOut(layer) {
  banner(null);
  controls?.pick(layer);
  if (session.state.tab !== "choose") session.choose((state) => (state.tab = "choose"), "tab");
  byId("choose").querySelector('[aria-invalid="true"]')?.focus();
}

/** Shows layers that the server has understood. */
function show(layers, understood, isChosen) {
  const spacings = understood.map((one) => one.spacing);
  const nearest = Math.min(...spacings);
  const before = plane.look?.spacing ?? nearest;
  if (isTooFar(session.state, nearest)) goBack(nearest);
  banner(notice, notice ? [["Close", () => banner(null)]] : []);
  notice = null;
  root.dataset.state = "loading";
  shownFirst();
  plane.show({ layers, spacings, ...palette() });
  const across = session.state.span / nearest;
  // A choice that leaves no point in view, or too many to tell apart, takes the view along.
  if (isChosen && (across < 4 || across > 2000)) session.state.span *= nearest / before;
  const { x, y, span } = session.state;
  plane.lookAt(x, y, span);
  plane.chunks.retry();
  for (const part of parts) part.shown(layers, understood);
}

/** From where there are no points to the place that was looked at before, or to the origin. */
function goBack(spacing) {
  const { x, y } = session.state;
  const words = `${spoken(toNumber(x), 4)}, ${spoken(toNumber(y), 4)}`;
  const isOnPlane = plane.span && !isTooFar(plane.view, spacing);
  const [to, name] = isOnPlane ? [plane.view, "the place before"] : [{ x: place(0), y: place(0) }, "the origin"];
  session.correct((state) => Object.assign(state, { x: to.x, y: to.y }));
  notice = `${words} is too far out: at this spacing numbers tell points apart up to ${spoken(farthest(spacing), 3)} from the origin. You see ${name}.`;
}

function jump(event) {
  event.preventDefault();
  const field = byId("jump-at");
  const [x, y] = field.value.split(/[,;]|\s+/).filter(Boolean).map(parsePlace);
  field.setAttribute("aria-invalid", String(!x || !y));
  if (!x || !y) {
    banner(`“${field.value}” is no place: two numbers are needed, such as 1e12, -3.5.`, [["Close", () => banner(null)]]);
    return;
  }
  if (plane.isTooFar({ x, y })) {
    field.setAttribute("aria-invalid", "true");
    const most = spoken(farthest(plane.look?.spacing ?? 1), 3);
    banner(`“${field.value}” is too far out: at this spacing numbers tell points apart up to ${most} from the origin.`, [["Close", () => banner(null)]]);
    return;
  }
  banner(null);
  session.choose((state) => Object.assign(state, { x, y }), "view");
  byId("plane").focus();
}

const ICONS = {
  closer: "M12 5v14M5 12h14",
  farther: "M5 12h14",
  home: "M3 11.5 12 4l9 7.5M6 10v10h12V10",
  share: "M10 14a4.5 4.5 0 0 0 6.4 0l3-3a4.5 4.5 0 0 0-6.4-6.4l-1 1M14 10a4.5 4.5 0 0 0-6.4 0l-3 3a4.5 4.5 0 0 0 6.4 6.4l1-1",
  theme: "M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9z",
  fold: "M6 15l6-6 6 6",
};

function tools() {
  for (const [id, path] of Object.entries(ICONS)) byId(id).append(icon(path));
  byId("jump").addEventListener("submit", jump);
  byId("closer").addEventListener("click", () => plane.zoom(1.5));
  byId("farther").addEventListener("click", () => plane.zoom(1 / 1.5));
  byId("home").addEventListener("click", () => {
    byId("jump-at").value = "";
    byId("jump-at").removeAttribute("aria-invalid");
    session.choose((state) => Object.assign(state, { x: place(0), y: place(0), span: 30 * (plane.look?.spacing ?? 1) }), "view");
  });
  byId("brand").addEventListener("click", (event) => {
    event.preventDefault();
    session.choose((state) => Object.assign(state, initial()), "layers", "view", "tab");
  });
  byId("share").addEventListener("click", share);
  byId("fold").addEventListener("click", () => fold(byId("fold").getAttribute("aria-expanded") === "true"));
  watchTheme(byId("theme"), () => {
    if (plane.look) plane.show({ ...plane.look, ...palette() });
    for (const part of parts) part.themed();
  });
}

/** Copies the address of the view. */
async function share() {
  session.save();
  let words = "The link is copied.";
  try {
    await navigator.clipboard.writeText(location.href);
  } catch {
    words = "The link is in the address bar of your browser: this page may not copy it.";
  }
  byId("said").textContent = words;
  byId("share").title = words;
  banner(words, [["Close", () => banner(null)]]);
}

function fold(isFolded) {
  byId("panel").classList.toggle("folded", isFolded);
  byId("fold").setAttribute("aria-expanded", String(!isFolded));
}

/** Tabs whose contents lie over the plane. */
const COVERS = ["gallery", "works"];
const TABS = ["start", "choose", "understand", "take", "gallery", "works"];

function tabs() {
  const buttons = TABS.map((name) => byId(`tab-${name}`));
  buttons.forEach((button, i) => {
    button.addEventListener("click", () => {
      fold(false);
      if (session.state.tab !== TABS[i]) session.choose((state) => (state.tab = TABS[i]), "tab");
    });
    button.addEventListener("keydown", (event) => {
      // What lies over the plane comes before the tabs in the page, but after them for keys.
      if (event.key === "Tab" && !event.shiftKey && COVERS.includes(TABS[i])) {
        event.preventDefault();
        return byId(TABS[i]).focus({ preventScroll: true });
      }
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const next = buttons[(i + step + buttons.length) % buttons.length];
      next.focus();
      next.click();
    });
  });
}

function showTab() {
  const { tab } = session.state;
  for (const name of TABS) {
    const isOpen = name === tab;
    byId(`tab-${name}`).setAttribute("aria-selected", String(isOpen));
    byId(`tab-${name}`).tabIndex = isOpen ? 0 : -1;
    byId(name).hidden = !isOpen;
  }
  if (root.dataset.tab !== tab) byId("panel-body").scrollTop = 0;
  root.dataset.tab = tab;
  // Nothing that is covered can have the focus.
  for (const part of /** @type {HTMLCollectionOf<HTMLElement>} */ (byId("stage").children)) {
    if (part.role !== "alert" && part.role !== "status") part.inert = COVERS.includes(tab) && part.id !== tab;
  }
  byId("gallery-help").hidden = tab !== "gallery";
  byId("works-help").hidden = tab !== "works";
  for (const part of parts) part.opened(tab);
}

/** @type {Controls | null} */
let controls = null;
/** The tables of the server. */
let tables = [];

const [understand, take] = [new Understand(session, plane), new Take(session, plane)];
const shade = new Shade(plane);
const works = new Works(session);
const card = new Card(session, plane);
const paint = new Paint(session, plane, {
  picked: () => controls?.picked ?? 0,
  say: (words) => banner(words, [["Close", () => banner(null)]]),
});
const start = new Start(session);
parts.push(start, card, understand, take, shade, works, paint);
tools();
skipLinks();
takeDrops(byId("stage"), stipple);
tabs();
showTab();
moveBy(byId("plane"), plane, {
  tapped: (at) => parts.forEach((part) => part.tapped(at)),
  hovered: (at) => parts.forEach((part) => part.hovered(at)),
});
session.on((changed) => {
  if (changed.has("layers")) settle(tables);
  if (changed.has("layers")) refresh(!changed.has("view"));
  else if (changed.has("view")) plane.lookAt(session.state.x, session.state.y, session.state.span);
  if (changed.has("tab")) showTab();
});

/** Stipples a picture with the layer that is picked. */
async function stipple(file) {
  if (!controls) return;
  if (file.name.endsWith(".json")) return paint.open(file);
  try {
    banner(`Sending “${file.name}” …`);
    const members = await sendPicture(file, plane.view);
    banner(null);
    controls.change(members);
  } catch (error) {
    banner(error.message, [["Close", () => banner(null)]]);
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
  if (wasChosen) notice = `This server has no profile “${missing.join("”, “")}”. You see “${standard}” in its place.`;
  session.correct((state) => {
    for (const layer of state.layers) {
      if (missing.includes(layer.profile)) Object.assign(layer, { profile: standard, alpha: "", map: "" });
    }
  });
}

/** A server that wants keys is given one. */
function askForKey() {
  if (byId("key")) return;
  banner("This server answers only those who have a key. It stays in this tab.");
  byId("banner").lastElementChild?.replaceWith(keyForm(() => {
    banner(null);
    if (controls) refresh();
    else begin();
  }));
  byId("key").focus();
}

/** Shows the layers before the server has said anything, where their spacings need no server. */
function beginEarly() {
  const { layers, x, y, span } = session.state;
  const spacings = layers.map(spacingOf);
  if (!spacings.every((spacing) => spacing > 1e-100 && spacing < 1e100) || isTooFar(session.state, Math.min(...spacings))) return;
  plane.show({ layers: layers.map((layer) => ({ ...layer })), spacings, ...palette() });
  plane.lookAt(x, y, span);
  notesOf(layers).catch(() => {});
}

/** The mean spacing of a layer, as far as it follows from its own words. */
function spacingOf({ by, amount }) {
  return by === "spacing" ? Number(amount) : by === "density" ? Number(amount) ** -0.5 : NaN;
}

/** Begins: first with points, then with what the server has to choose from. */
async function begin() {
  try {
    if (!plane.span) beginEarly();
    const [{ profiles }, { fields }] = await Promise.all([askJson("/v1/profiles"), askJson("/v1/fields")]);
    settle(profiles);
    tables = profiles;
    controls = new Controls(session, profiles, fields, stipple);
    const gallery = new Gallery(session, profiles);
    Object.assign(globalThis.strew, { gallery, controls });
    parts.push(gallery);
    gallery.opened(session.state.tab);
    await refresh();
  } catch (error) {
    if (error.isLocked) return askForKey();
    if (!(error instanceof Gone)) return banner(error.message, [["Try again", begin]]);
    onPresence((gone) => gone || controls || begin());
  }
}

// For the curious, and for tests.
globalThis.strew = { plane, start, card, shade, stipple, session, status, understand, take, works, paint };
begin();
