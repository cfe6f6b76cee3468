// The page of space: a volume to turn, zoom and fly through, and the request for the chunk in the middle.

import { isSeed } from "../address.js";
import { isAway } from "../api.js";
import { byId, bytes, copy, counted, icon, make, settled, skipLinks } from "../dom.js";
import { fault, field, select, setOptions } from "../form.js";
import { tools } from "../gestures.js";
import { Notice } from "../notice.js";
import { formatPlace, place } from "../place.js";
import { themeNumbers } from "../theme.js";
import { fineness, sized } from "../view.js";
import { cameraOf } from "../walk/camera.js";
import { sceneOn } from "./scene.js";
import { PROFILES, REACH, fromHash, isInReach, isSpacing, toHash } from "./state.js";
import { Viewer } from "./viewer.js";
import { Volume, chunkAt, cornerOf, pathOf, sizeFor } from "./volume.js";

/** Milliseconds without a byte after which the page says that it waits. */
const PATIENCE = 1500;

const root = document.documentElement;
const canvas = byId("view");
const state = fromHash(location.hash);
/** Nothing where there is no WebGL2: the fields and the request work without a picture. */
const scene = sceneOn(canvas);

const notice = new Notice(byId("banner"), () => {
  volume.chunks.retry();
  later();
}, () => later());
notice.say("wrong", state.wrong.join(" ") || null);
if (!scene) notice.say("blind", "The picture needs WebGL2, which this browser does not have. The request for the points works without.");

const volume = new Volume(() => (isStale = true), (error) => notice.refused(error));
const viewer = new Viewer(canvas, state, () => {
  notice.say("wrong", null);
  later();
});

/** @type {import("./scene.js").Colors} */
let colors;
let isStale = true;

function themed() {
  colors = { ground: themeNumbers("void"), near: themeNumbers("near"), far: themeNumbers("far"), line: themeNumbers("ink") };
  isStale = true;
}

/** What is seen from the eye, in mean spacings. */
function look() {
  const { at, yaw, pitch, away, reach, spacing } = state;
  const unit = Number(spacing);
  const camera = cameraOf({ yaw, pitch }, canvas.clientWidth / Math.max(1, canvas.clientHeight), away + 2 * reach + 10);
  const middle = camera.ahead.map((v) => v * away);
  const seen = (corner) => corner.map((v, axis) => v / unit + middle[axis]);
  const here = chunkAt(at, sizeFor(unit));
  const done = volume.chunks.wanted.filter((chunk) => chunk.state === "done");
  return {
    camera, middle, reach, colors,
    scale: 1 / unit,
    depths: [Math.max(0, away - reach), away + reach],
    chunks: done.map((chunk) => ({ chunk, corner: seen(cornerOf(chunk, at)) })),
    box: { corner: seen(cornerOf(here, at)), side: here.size / unit },
  };
}

let before = performance.now();
let pictured = "";

function frame(now) {
  const seconds = Math.min(0.1, (now - before) / 1000);
  before = now;
  viewer.step(seconds);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((v) => Math.round(v * fineness()));
  const same = [...state.at.flatMap(({ i, f }) => [i, f]), state.yaw, state.pitch, state.away, state.reach, width, height].join();
  // A still picture is drawn once.
  if (isStale || same !== pictured) {
    sized(canvas, [width, height]);
    volume.move(state);
    scene?.draw(look());
    [isStale, pictured] = [false, same];
    tell(now);
  } else if (root.dataset.state === "loading") {
    tell(now);
  }
  requestAnimationFrame(frame);
}

let heard = { received: -1, at: 0 };

/** The line below, and whether the server takes long. */
function tell(now) {
  const { points, chunks, wanted, received, isBusy } = volume.sums;
  if (received !== heard.received || chunks === wanted) heard = { received, at: now };
  const isLong = now - heard.at > PATIENCE && !isAway();
  notice.say("busy", isBusy ? "The server is busy. This page tries again by itself." : isLong ? "The server is slow to answer." : null);
  root.dataset.state = notice.said.refused ? "failed" : chunks === wanted ? "ready" : "loading";
  const parts = [`${counted(points)} in ${chunks === wanted ? counted(chunks, "chunk") : `${chunks} of ${wanted} chunks`}`, bytes(received),
    `at ${state.at.map((one) => formatPlace(one, Number(state.spacing) < 1 ? 2 : 0)).join(", ")}`];
  const text = parts.join(" · ");
  if (byId("tally").textContent !== text) byId("tally").textContent = text;
  byId("turn").setAttribute("aria-pressed", String(viewer.isTurning));
}

/** What follows a move, once it is over: the address and the request. */
const later = settled(350, () => {
  const hash = toHash(state);
  if (hash !== location.hash) history.replaceState(null, "", hash);
  const here = chunkAt(state.at, sizeFor(Number(state.spacing)));
  byId("command").textContent = `curl -f '${location.origin}${pathOf(state, here, "csv")}' -o chunk.csv`;
  const { points, chunks } = volume.sums;
  byId("spoken").textContent = `${counted(points)} in ${counted(chunks, "chunk")} around ${state.at.map((one) => formatPlace(one, 0)).join(", ")}`;
});

/** Takes another value of a field. */
function choose(name, value) {
  state[name] = value;
  notice.say("refused", null);
  notice.say("wrong", null);
  isStale = true;
  later();
}

function text(id, words, isRight, wrong) {
  const changed = (event) => {
    const value = event.target.value.trim();
    fault(byId("fields"), id, isRight(value) ? null : wrong);
    if (isRight(value)) choose(id, value);
  };
  const mode = id === "seed" ? "numeric" : "decimal";
  return field(words, id, make("input", { id, inputmode: mode, autocomplete: "off", spellcheck: "false", oninput: changed }));
}

byId("fields").append(
  make("div", { class: "pair" },
    text("spacing", "Mean spacing", (value) => isSpacing(value) && isInReach(state.at, value),
      "The mean spacing must be a number from 0.001 to 1000000; far from the origin it must not be small."),
    text("seed", "Seed", isSeed, "The seed must be a whole number from 0 to 18446744073709551615.")),
  make("div", { class: "pair" },
    field("Profile", "profile", select("profile", (value) => choose("profile", value))),
    field("Reach, in spacings", "reach", make("input", {
      id: "reach", type: "range", min: REACH[0], max: REACH[1], oninput: (event) => choose("reach", Number(event.target.value)),
    }))),
);

function fill() {
  setOptions(byId("profile"), PROFILES, state.profile);
  for (const id of ["spacing", "seed", "reach"]) {
    /** @type {HTMLInputElement} */ (byId(id)).value = String(state[/** @type {"spacing"} */ (id)]);
    fault(byId("fields"), id, null);
  }
}

/** Goes to a state of an address. */
function go(next) {
  Object.assign(state, next);
  home = null;
  byId("jump").textContent = "Jump far away";
  notice.say("wrong", state.wrong.join(" ") || null);
  notice.say("refused", null);
  fill();
  isStale = true;
  later();
}

/** @type {import("../place.js").Place[] | null} */
let home = null;

/** Goes to where doubles have nine digits fewer left, and back to the same points. */
function jump() {
  const far = Math.min(1e9, 1e10 * Number(state.spacing));
  const here = state.at;
  state.at = home ?? [place(far), place(far), place(far)];
  home = home ? null : here;
  byId("jump").textContent = home ? "Jump back" : "Jump far away";
  viewer.took();
}

const ICONS = {
  up: "M5 13l7-7 7 7M12 6v14", down: "M5 11l7 7 7-7M12 18V4", left: "M15 5l-7 7 7 7", right: "M9 5l7 7-7 7",
  forth: "M5 15l7-7 7 7", back: "M5 9l7 7 7-7",
};
for (const [move, path] of Object.entries(ICONS)) {
  byId(`pad-${move}`).append(icon(path));
  viewer.button(byId(`pad-${move}`), move);
}
byId("jump").addEventListener("click", jump);
byId("inside").addEventListener("click", () => {
  state.away = 0;
  viewer.took();
});
byId("turn").addEventListener("click", () => {
  viewer.isTurning = !viewer.isTurning;
  isStale = true;
});
byId("copy").addEventListener("click", (event) => copy(byId("command"), /** @type {HTMLElement} */ (event.currentTarget)));
tools(viewer, () => go({ ...fromHash(""), spacing: state.spacing, seed: state.seed, profile: state.profile }), themed);
canvas.addEventListener("webglcontextlost", () => location.reload());
addEventListener("hashchange", ({ newURL }) => go(fromHash(new URL(newURL).hash)));
skipLinks();
fill();
later();

// For the curious, and for tests.
globalThis.strew = { state, viewer, volume, scene };
requestAnimationFrame(frame);
