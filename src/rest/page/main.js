// The page: puts its parts together.

import { Gone, askJson, onPresence, useKey } from "./api.js";
import { Card } from "./card.js";
import { Controls } from "./controls.js";
import { byId, icon, make, settled } from "./dom.js";
import { Gallery } from "./gallery.js";
import { moveBy } from "./gestures.js";
import { parsePlace, place } from "./place.js";
import { sendPicture, takeDrops } from "./picture.js";
import { Plane } from "./plane.js";
import { Session } from "./session.js";
import { Shade } from "./shade.js";
import { Status } from "./status.js";
import { LAYER, initial } from "./state.js";
import { Take } from "./take.js";
import { palette, watchTheme } from "./theme.js";
import { Understand } from "./understand.js";
import { Works } from "./works/works.js";

const root = document.documentElement;
const session = new Session();

const parts = [];
const plane = new Plane(byId("plane"), session.state.renderer, {
  moved: () => {
    // Before the server has said what a spacing is, nothing is looked at.
    if (!plane.span) return;
    session.viewed(plane.view, plane.span);
    root.dataset.state = "loading";
    status.moved();
    for (const part of parts) part.moved?.();
  },
  progress: (share) => {
    const bar = byId("progress");
    bar.hidden = share >= 1;
    bar.setAttribute("aria-valuenow", String(Math.round(share * 100)));
    bar.firstElementChild.style.transform = `scaleX(${share})`;
    for (const part of parts) part.painted?.();
  },
  settled: () => {
    if (root.dataset.state === "loading") root.dataset.state = "ready";
    rested();
  },
  failed: (error) => {
    root.dataset.state = "failed";
    banner(error.message, [["Try again", () => {
      banner(null);
      root.dataset.state = "loading";
      plane.chunks.retry();
      plane.draw();
    }]]);
  },
});
const status = new Status(session, plane);
root.dataset.renderer = plane.painter.name;
const rested = settled(250, () => {
  for (const part of parts) part.rested?.();
});

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
    refresh();
    status.moved();
  }
});

let latest = 0;

/** Has the server understand the layers, then shows them. */
async function refresh() {
  latest += 1;
  const mine = latest;
  const layers = session.state.layers.map((layer) => ({ ...layer }));
  const notes = await Promise.all(layers.map(async (layer) => {
    try {
      return { understood: await session.understand(layer) };
    } catch (error) {
      return { error: error.message, isGone: error instanceof Gone };
    }
  }));
  if (mine !== latest) return;
  controls?.note(notes);
  if (notes.some((note) => note.isGone)) return;
  if (notes.some((note) => note.error)) {
    root.dataset.state = "failed";
    return;
  }
  banner(null);
  root.dataset.state = "loading";
  root.dataset.shown = "";
  plane.show({ layers, spacings: notes.map((note) => note.understood.spacing), ...palette() });
  if (!plane.span) plane.lookAt(session.state.x, session.state.y, session.state.span);
  status.moved();
  for (const part of parts) part.shown?.(layers, notes.map((note) => note.understood));
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
  banner(null);
  session.choose((state) => Object.assign(state, { x, y }), "view");
  byId("plane").focus();
}

const ICONS = {
  closer: "M12 5v14M5 12h14",
  farther: "M5 12h14",
  home: "M3 11.5 12 4l9 7.5M6 10v10h12V10",
  theme: "M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9z",
  fold: "M6 15l6-6 6 6",
};

function tools() {
  for (const [id, path] of Object.entries(ICONS)) byId(id).append(icon(path));
  byId("jump").addEventListener("submit", jump);
  byId("closer").addEventListener("click", () => plane.zoom(1.5));
  byId("farther").addEventListener("click", () => plane.zoom(1 / 1.5));
  byId("home").addEventListener("click", () => {
    session.choose((state) => Object.assign(state, { x: place(0), y: place(0), span: 30 * plane.look.spacing }), "view");
  });
  byId("brand").addEventListener("click", (event) => {
    event.preventDefault();
    session.choose((state) => Object.assign(state, initial()), "layers", "view", "tab");
  });
  byId("fold").addEventListener("click", () => fold(byId("fold").getAttribute("aria-expanded") === "true"));
  watchTheme(byId("theme"), () => {
    if (plane.look) plane.show({ ...plane.look, ...palette() });
    for (const part of parts) part.themed?.();
  });
}

function fold(isFolded) {
  byId("panel").classList.toggle("folded", isFolded);
  byId("fold").setAttribute("aria-expanded", String(!isFolded));
}

const TABS = ["choose", "understand", "take", "gallery", "works"];

function tabs() {
  const buttons = TABS.map((name) => byId(`tab-${name}`));
  buttons.forEach((button, i) => {
    button.addEventListener("click", () => {
      fold(false);
      if (session.state.tab !== TABS[i]) session.choose((state) => (state.tab = TABS[i]), "tab");
    });
    button.addEventListener("keydown", (event) => {
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
  byId("gallery-help").hidden = tab !== "gallery";
  byId("works-help").hidden = tab !== "works";
  for (const part of parts) part.opened?.(tab);
}

let controls = null;

const [understand, take] = [new Understand(session, plane), new Take(session, plane)];
const shade = new Shade(plane);
const works = new Works(session);
parts.push(new Card(session, plane), understand, take, shade, works);
tools();
takeDrops(byId("stage"), stipple);
tabs();
showTab();
moveBy(byId("plane"), plane, {
  tapped: (at) => parts.forEach((part) => part.tapped?.(at)),
  hovered: (at) => parts.forEach((part) => part.hovered?.(at)),
  settled: () => {},
});
session.on((changed) => {
  if (changed.has("view")) plane.lookAt(session.state.x, session.state.y, session.state.span);
  if (changed.has("layers")) refresh();
  if (changed.has("tab")) showTab();
});

/** Stipples a picture with the layer that is picked. */
async function stipple(file) {
  if (!controls) return;
  try {
    banner(`Sending “${file.name}” …`);
    const members = await sendPicture(file, plane.view);
    banner(null);
    controls.change(members);
  } catch (error) {
    banner(error.message, [["Close", () => banner(null)]]);
  }
}

/** A server without the profile that everybody begins with shows its first one. */
function settle(profiles) {
  const isLoaded = profiles.some((table) => table.profile === LAYER.profile);
  if (isLoaded || location.hash.includes("profile=") || profiles.length === 0) return;
  session.state.layers[0].profile = profiles[0].profile;
}

/** A server that wants keys is given one. */
function askForKey(words) {
  const field = make("input", { type: "password", id: "key", "aria-label": "Key", autocomplete: "off" });
  banner(words, [["Use this key", () => {
    useKey(field.value);
    begin();
  }]]);
  byId("banner").lastElementChild.prepend(field);
  field.focus();
}

/** Begins as soon as the server has told which profiles it has. */
async function begin() {
  try {
    const [{ profiles }, { fields }] = await Promise.all([askJson("/v1/profiles"), askJson("/v1/fields")]);
    settle(profiles);
    controls = new Controls(session, profiles, fields, stipple);
    const gallery = new Gallery(session, profiles);
    parts.push(gallery);
    gallery.opened(session.state.tab);
    banner(null);
    await refresh();
  } catch (error) {
    if (error.isLocked) return askForKey(error.message);
    if (!(error instanceof Gone)) return banner(error.message, [["Try again", begin]]);
    onPresence((gone) => gone || controls || begin());
  }
}

// For the curious, and for tests.
globalThis.strew = { plane, shade, stipple, session, status, understand, take, works };
begin();
