// The page of space: a volume to turn, zoom and fly through, and the request for the chunk in the middle.

import { isSeed } from "../address.js";
import { byId, bytes, copy, counted, icon, settled, skipLinks } from "../dom.js";
import { fault, wrongAt } from "../form.js";
import { tools } from "../gestures.js";
import { Notice } from "../notice.js";
import { formatPlace, place } from "../place.js";
import { themeNumbers } from "../theme.js";
import { fineness, sized } from "../view.js";
import { cameraOf } from "../walk/camera.js";
import { sceneOn } from "./scene.js";
import { fromHash, isInReach, isSpacing, toHash } from "./state.js";
import { Viewer } from "./viewer.js";
import { Volume, chunkAt, cornerOf, pathOf, sizeFor } from "./volume.js";

const root = document.documentElement;
const canvas = byId("view");
const state = fromHash(location.hash);
/** Nothing where there is no WebGL2: the fields and the request work without a picture. */
const scene = sceneOn(canvas);

const notice = new Notice(byId("banner"), () => {
  volume.chunks.retry();
  later();
}, () => later());
notice.say("wrong", state.wrong);
if (!scene) notice.say("blind", "The picture needs WebGL2, which this browser does not have. The request for the points works without.");

const volume = new Volume(() => (isStale = true), (error) => notice.refused(error));
notice.awaited = volume;
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
    tell();
  }
  requestAnimationFrame(frame);
}

/** The line below. */
function tell() {
  const { points, done, wanted, received } = volume.chunks.sums;
  root.dataset.state = notice.said.refused ? "failed" : done === wanted ? "ready" : "loading";
  if (done < wanted) notice.watch();
  const parts = [`${counted(points)} in ${done === wanted ? counted(done, "chunk") : `${done} of ${wanted} chunks`}`, bytes(received),
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
  const { points, done } = volume.chunks.sums;
  byId("spoken").textContent = `${counted(points)} in ${counted(done, "chunk")} around ${state.at.map((one) => formatPlace(one, 0)).join(", ")}`;
});

/** Takes another value of a field. */
function choose(name, value) {
  state[name] = value;
  notice.say("refused", null);
  notice.say("wrong", null);
  isStale = true;
  later();
}

/** Has a field of text choose what is right, and say what is wrong. */
function text(id, isRight, wrong) {
  const input = /** @type {HTMLInputElement} */ (byId(id));
  wrongAt(input);
  input.addEventListener("input", () => {
    const value = input.value.trim();
    fault(byId("fields"), id, isRight(value) ? null : wrong);
    if (isRight(value)) choose(id, value);
  });
}

text("spacing", (value) => isSpacing(value) && isInReach(state.at, value),
  "The mean spacing must be a number from 0.001 to 1000000; far from the origin it must not be small.");
text("seed", isSeed, "The seed must be a whole number from 0 to 18446744073709551615.");
byId("profile").addEventListener("change", () => choose("profile", byId("profile").value));
byId("reach").addEventListener("input", () => choose("reach", Number(byId("reach").value)));

function fill() {
  for (const id of /** @type {const} */ (["spacing", "seed", "profile", "reach"])) {
    byId(id).value = String(state[id]);
    fault(byId("fields"), id, null);
  }
}

/** Goes to a state of an address. */
function go(next) {
  Object.assign(state, next);
  home = null;
  byId("jump").textContent = "Jump far away";
  notice.say("wrong", state.wrong);
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
