// The page of a tile: what repeats, how it looks next to its copies, and the files of it.

import { Gone, askJson, onPresence } from "../api.js";
import { tools } from "../bar.js";
import { curl } from "../commands.js";
import { Joint } from "../compare/joint.js";
import { byId, contextOf, copy, make, settled, skipLinks } from "../dom.js";
import { save } from "../download.js";
import { faultsOf } from "../faults.js";
import { check, fault, field, refusal, select, setOptions } from "../form.js";
import { moveBy } from "../gestures.js";
import { distance, place } from "../place.js";
import { choicesOf, profileNames } from "../profiles.js";
import { joined } from "../query.js";
import { themeColor } from "../theme.js";
import { Mask, pairsOf as maskPairs } from "./mask.js";
import { Period, pairsOf as periodPairs } from "./period.js";
import { LEAST_SHARE, SIZES, fromHash, spanOf, toHash } from "./state.js";

const root = document.documentElement;
const canvas = byId("view");
/** The fewest and the most units along the shorter side: mean spacings, or pixels of a mask. */
const LEAST_SPAN = 6;
const mostSpan = ({ what, size }) => (what === "mask" ? 2.5 * size : 250);
/** Periods of more points are not offered here: a page that shows copies of them is slow. */
const MOST_POINTS = 60_000;
const FILES = ["png", "svg", "csv", "json", "f32", "npy"];
const SIDES = ["512", "1024", "2048", "4096"];

let state = fromHash(location.hash);
let tables = [];
const kinds = { points: new Period(canvas), mask: new Mask(canvas) };
const joint = new Joint(state, () => draw(), (span) => Math.min(mostSpan(state), Math.max(LEAST_SPAN, span)));
const shown = () => kinds[state.what];
const file = { format: "png", side: "1024" };

let isWaiting = false;

function draw() {
  if (isWaiting) return;
  isWaiting = true;
  requestAnimationFrame(() => {
    isWaiting = false;
    shown().draw(joint.view);
    if (state.seams && shown().isThere) seams(joint.view, shown().side);
  });
}

/** Lines where copies meet. */
function seams({ x, y, unit, ratio, pixels }, side) {
  const [width, height] = pixels;
  const context = contextOf(canvas);
  const scale = ratio / unit;
  const lines = (at, size, line) => {
    const from = size / 2 + at * scale;
    for (let v = from - Math.floor(from / (side * scale)) * side * scale; v < size; v += side * scale) line(Math.round(v) + 0.5);
  };
  context.strokeStyle = themeColor("accent");
  context.lineWidth = 1.5 * ratio;
  context.setLineDash([6 * ratio, 5 * ratio]);
  context.beginPath();
  lines(distance(place(0), x), width, (v) => {
    context.moveTo(v, 0);
    context.lineTo(v, height);
  });
  lines(-distance(place(0), y), height, (v) => {
    context.moveTo(0, v);
    context.lineTo(width, v);
  });
  context.stroke();
  context.setLineDash([]);
}

let turn = 0;

/** Takes what is chosen to the server, and shows what comes back; `how` says whether Back undoes the choice. */
async function show(how = "replaceState") {
  turn += 1;
  const mine = turn;
  const kind = shown();
  root.dataset.state = "loading";
  const hash = toHash(state);
  if (hash !== location.hash) history[how](null, "", hash);
  update();
  try {
    const made = await kind.load({ ...state, map: mapOf(state.profile) });
    // A late answer does not replace a newer choice.
    if (mine !== turn) return;
    kind.take(made);
    byId("about").textContent = made.words;
    fault(byId("choices"), "seed", "");
    byId("banner").hidden = true;
    root.dataset.state = "ready";
  } catch (error) {
    // The page says already that the server does not answer, and asks again.
    if (mine !== turn || error instanceof Gone) return;
    const { seed } = faultsOf(error);
    if (seed) fault(byId("choices"), "seed", seed);
    else refusal(byId("banner"), error, () => begin());
    kind.clear();
    byId("about").textContent = "";
    root.dataset.state = "failed";
  }
  picture();
  draw();
}

function picture() {
  const { isThere } = shown();
  // It keeps its room while it waits.
  byId("shown").classList.toggle("waits", !isThere);
  for (const id of ["download", "copy"]) byId(id).toggleAttribute("disabled", !isThere);
  if (!isThere) return;
  byId("caption").textContent = shown().picture(byId("picture"));
  byId("picture").setAttribute("aria-label", state.what === "mask" ? "A dithered ramp" : "The spectrum");
}

const soon = settled(250, show);

/** A choice that Back undoes. */
function choose(change) {
  const before = spanOf(state);
  Object.assign(state, change);
  if (change.what || spanOf(state) !== before) joint.lookAt(place(0), place(0), spanOf(state));
  show("pushState");
}

/** The smallest map of a profile's tables: it has the shortest periods. */
function mapOf(profile) {
  const { maps } = choicesOf(tables, { profile, alpha: "", map: "" });
  return maps[0];
}

function build() {
  // Its room is known before it is drawn.
  Object.assign(byId("picture"), { width: 320, height: state.what === "mask" ? 110 : 320 });
  const buttons = [["points", "Points"], ["mask", "Mask"]].map(([what, words]) => make("button", {
    type: "button", id: `what-${what}`, onclick: () => choose({ what }),
  }, words));
  byId("what").append(...buttons);
  const seed = make("input", {
    id: "seed", inputmode: "numeric", autocomplete: "off", spellcheck: "false",
    oninput: (event) => {
      state.seed = event.target.value.trim();
      soon();
    },
  });
  const share = make("input", {
    type: "range", id: "share", min: String(LEAST_SHARE), max: "1", step: "0.01", oninput: (event) => {
      state.share = Number(event.target.value);
      sayShare();
      soon();
    },
  });
  byId("fields").append(
    field("Profile", "profile", select("profile", (profile) => {
      state.profile = profile;
      begin("pushState");
    })),
    make("div", { class: "pair", id: "of-points" },
      field("Points", "points", select("points", (points) => choose({ points: Number(points) }))),
      field("Share kept", "share", share)),
    make("div", { class: "pair", id: "of-mask" },
      field("Pixels per side", "size", select("size", (size) => choose({ size: Number(size) }))),
      field("Bits", "bits", select("bits", (bits) => choose({ bits })))),
    field("Seed", "seed", seed),
    check("seams", "Show the seams", (seams) => {
      state.seams = seams;
      history.replaceState(null, "", toHash(state));
      draw();
    }),
  );
  const format = select("format", (value) => {
    file.format = value;
    line();
  }, { "aria-label": "Format" });
  const side = select("side", (value) => {
    file.side = value;
    line();
  }, { "aria-label": "Pixels per side of the picture" });
  setOptions(format, FILES, file.format);
  setOptions(side, SIDES.map((v) => [v, `${v} pixels`]), file.side);
  byId("save").append(
    make("div", { class: "pair", id: "how" }, format, side),
    make("button", { type: "button", id: "download", class: "main", onclick: () => save({ path: pathOf() }, nameOf(), () => {})
      .catch((error) => refusal(byId("banner"), error, () => begin())) }, "Save"),
    make("pre", { role: "group", tabindex: "0", "aria-label": "The request" }, make("code", { id: "command" })),
    make("button", { type: "button", id: "copy", onclick: (event) => copy(byId("command"), event.currentTarget) }, "Copy"),
    make("p", { class: "note", id: "help" }),
  );
  which();
  picture();
}

/** Shows the fields of points, or those of a mask. */
function which() {
  const isMask = state.what === "mask";
  byId("of-points").hidden = isMask;
  byId("of-mask").hidden = !isMask;
  byId("how").hidden = isMask;
}

/** Sets every field to what is chosen. */
function update() {
  which();
  for (const what of Object.keys(kinds)) byId(`what-${what}`).setAttribute("aria-pressed", String(what === state.what));
  setOptions(byId("size"), SIZES.map(String), String(state.size));
  setOptions(byId("bits"), [["8", "8"], ["16", "16"]], state.bits);
  if (byId("seed").value.trim() !== state.seed) byId("seed").value = state.seed;
  byId("share").value = String(state.share);
  sayShare();
  /** @type {HTMLInputElement} */ (byId("seams")).checked = state.seams;
  line();
}

function sayShare() {
  const share = `${Math.round(100 * state.share)} %`;
  byId("share").setAttribute("aria-valuetext", share);
  /** @type {HTMLElement} */ (document.querySelector("label[for=share]")).textContent = `Share kept: ${share}`;
}

function pathOf() {
  const whole = { ...state, map: mapOf(state.profile) };
  if (state.what === "mask") return `/v1/mask.png?${joined(maskPairs(whole))}`;
  const size = isPicture() ? [["size", file.side]] : [];
  return `/v1/points?${joined([...periodPairs(whole), ["format", file.format], ...size])}`;
}

const isPicture = () => ["png", "svg"].includes(file.format);
const nameOf = () => (state.what === "mask" ? "mask.png" : `points.${file.format}`);

/** The line to paste, and what to do with the file. */
function line() {
  byId("side").toggleAttribute("disabled", !isPicture());
  byId("copy").textContent = "Copy";
  byId("command").textContent = curl(location.origin, { path: pathOf() }, nameOf());
  byId("help").textContent = state.what === "mask"
    ? "Repeat it over a picture, one pixel of the mask to one pixel of the picture."
    : "Pictures repeat as they are. Coordinates run from 0 to below L in x and y; L is the side in mean spacings.";
}

async function begin(how) {
  try {
    ({ profiles: tables } = await askJson("/v1/profiles"));
    const names = profileNames(tables);
    if (!names.includes(state.profile)) {
      byId("banner").hidden = false;
      byId("banner").textContent = `This server has no profile “${state.profile}”.`;
      [state.profile] = names.includes("blue") ? ["blue"] : names;
    }
    setOptions(byId("profile"), names, state.profile);
    await sizes();
  } catch (error) {
    if (!(error instanceof Gone)) refusal(byId("banner"), error, () => begin());
    root.dataset.state = "failed";
    return;
  }
  const said = byId("banner").hidden ? "" : byId("banner").textContent;
  await show(how);
  if (said && root.dataset.state === "ready") Object.assign(byId("banner"), { hidden: false, textContent: said });
}

/** Offers the periods that the profile has. */
async function sizes() {
  const { periods } = await askJson(`/v1/periods?${joined([["profile", state.profile], ["map", mapOf(state.profile)], ["most", "12"]])}`);
  const counts = periods.map(({ points }) => points).filter((points, i) => i === 0 || points <= MOST_POINTS);
  state.points = counts.find((points) => points >= state.points) ?? counts[counts.length - 1];
  setOptions(byId("points"), counts.map((points) => [String(points), points.toLocaleString("en")]), String(state.points));
}

function resize() {
  const { clientWidth, clientHeight } = canvas;
  if (clientWidth && clientHeight) joint.resize(clientWidth, clientHeight);
}

onPresence((gone) => {
  Object.assign(byId("banner"), { hidden: !gone, textContent: gone ? "The server does not answer. This page tries again by itself." : "" });
  if (!gone) begin();
});

addEventListener("hashchange", () => {
  state = Object.assign(joint.state, fromHash(location.hash));
  joint.lookAt(state.x, state.y, state.span);
  begin();
});

// For tests.
globalThis.strew = { joint, kinds };
build();
tools(joint, () => joint.lookAt(place(0), place(0), spanOf(state)), () => {
  kinds.points.renew();
  picture();
  draw();
});
moveBy(canvas, joint, { tapped: () => {}, hovered: () => {} });
new ResizeObserver(resize).observe(canvas);
skipLinks();
begin();
