// The walk: puts its parts together and draws, as finely as the machine can.

import { givenIn, hashOf, isSeed } from "../address.js";
import { askJson } from "../api.js";
import { byId, bytes, make } from "../dom.js";
import { Notice } from "../notice.js";
import { formatPlace, place } from "../place.js";
import { joined, setOf } from "../query.js";
import { LAYER, initial, toHash } from "../state.js";
import { isDark, watchTheme } from "../theme.js";
import { cameraOf } from "./camera.js";
import { Plan } from "./map.js";
import { STEEPEST, Walker, stick } from "./move.js";
import { sceneOn } from "./scene.js";
import { World, layersOf } from "./world.js";

/**
 * How finely the picture is drawn: pixels for each CSS pixel; for each set how far all of its points are drawn and how
 * far any; how fine the ground is; within which distances things have all of their triangles and some of them; whether
 * there are shadows and a finer ground.
 */
const QUALITIES = [
  { ratio: 0.5, sets: [{ near: 24, reach: 420 }, { near: 4, reach: 12 }], cells: 16, detail: [0, 1], isFine: false },
  { ratio: 0.75, sets: [{ near: 40, reach: 640 }, { near: 6, reach: 24 }], cells: 16, detail: [1, 70], isFine: false },
  { ratio: 1, sets: [{ near: 64, reach: 1000 }, { near: 9, reach: 44 }], cells: 32, detail: [70, Infinity], isFine: true },
  { ratio: 2, sets: [{ near: 96, reach: 1500 }, { near: 13, reach: 64 }], cells: 32, detail: [70, Infinity], isFine: true },
];
/** A frame that takes longer (in milliseconds) is too slow; one that takes less leaves room for more. */
const SLOW = 45;
const QUICK = 18;
/** Frames that decide about it. */
const FRAMES = 30;
/** The small map is drawn again after this time at the earliest, in milliseconds, with graphics hardware and without. */
const MAPPED = [100, 500];

const root = document.documentElement;
const canvas = byId("view");
const FAR = [place(1e9), place(1e9)];

function fromHash(hash) {
  const given = givenIn(hash);
  const [x, y] = given.at();
  const isNear = x && y && Math.max(Math.abs(x.i), Math.abs(y.i)) <= 1e14;
  const radians = (name, otherwise) => ((given.number(name, otherwise) % 360) * Math.PI) / 180;
  const quality = given.matching("quality", (text) => /^[0-3]$/.test(text));
  const read = {
    x: isNear ? x : place(START.x), y: isNear ? y : place(START.y),
    yaw: radians("yaw", START.yaw), pitch: Math.max(-STEEPEST, Math.min(STEEPEST, radians("pitch", -5))),
    seed: given.matching("seed", isSeed, "7"),
    quality: quality ? Number(quality) : null,
    isFlying: given.text("fly") !== "0" && !given.has("at"),
    isAloft: given.text("fly") === "1",
    isAnywhere: !isNear,
    isMap: given.text("map") === "1",
    /** Whether it is the flight of the first page: always at dusk, with nothing to use. */
    isScenery: given.text("scenery") === "1",
  };
  const isOut = x && y && !isNear;
  notice.say("wrong", isOut ? "This walk ends at 1e14 in every direction, so it starts at its beginning instead." : given.wrong());
  return read;
}

/** Where a walk begins: above the trail, or in a clearing nearby. */
const START = { x: -126, y: 0, yaw: 16 };

const notice = new Notice(byId("banner"), () => {
  root.dataset.state = "loading";
  for (const { chunks } of world.sets) chunks.retry();
}, () => {});

let given = fromHash(location.hash);
/** What takes the place of the scene where there is no WebGL2, and where an address wants the map alone: nothing is drawn. */
const BLIND = { isSlow: true, isBlind: true, mode: "day", buffer: () => null, free: () => {}, resize: () => {}, draw: () => 0 };
const { isMap: wantsMap, isScenery } = given;
root.toggleAttribute("data-scenery", isScenery);
const scene = (!wantsMap && sceneOn(canvas)) || BLIND;
root.toggleAttribute("data-blind", scene.isBlind);
if (scene.isBlind) notice.say("blind", "This browser cannot draw in three dimensions (WebGL2 is missing), so here is the map. Keys and sticks walk as usual.");

function failed(error) {
  root.dataset.state = "failed";
  notice.refused(error);
}

let world = new World(scene, given.seed, failed);
const walker = new Walker(canvas, given, (at) => pick(at));
let level = given.quality ?? (scene.isSlow ? 0 : 2);
let best = QUALITIES.length - 1;
let frames = [];
/** @type {any} */
let look = null;
let before = performance.now();

/** Draws coarser if frames take long, finer if there is room; what was too fine once is not tried again. */
function adapt(took) {
  if (given.quality !== null || document.hidden) return;
  frames.push(took);
  if (frames.length < FRAMES) return;
  const median = frames.sort((a, b) => a - b)[FRAMES / 2];
  frames = [];
  if (median > SLOW && level > 0) best = level -= 1;
  else if (median < QUICK && level < Math.min(best, scene.isSlow ? 1 : best)) level += 1;
}

/** The state that the last picture was drawn from. */
let pictured = "";
let drawn = 0;
/** The small map, the state that it shows, and since when. */
const chart = new Plan(byId("map"));
let charted = "";
let chartedAt = 0;

function frame(now) {
  const passed = (now - before) / 1000;
  const last = before;
  before = now;
  const quality = QUALITIES[level];
  // Wind means that every frame is another picture: too much without graphics hardware.
  const hasWind = walker.mayFly && !scene.isSlow;
  const { sets } = quality;
  scene.resize(Math.min(quality.ratio, devicePixelRatio * Math.min(1, quality.ratio)));
  world.move(walker, [Math.sin(walker.yaw), Math.cos(walker.yaw)], quality);
  walker.step(passed, (at) => world.heightAt(at));
  const camera = cameraOf(walker, canvas.clientWidth / Math.max(1, canvas.clientHeight), 1.5 * sets[0].reach);
  const lift = (walker.height ?? 0) - world.heightAt(walker);
  look = { ...world.look(walker, now - last), camera, at: { x: walker.x, y: walker.y }, height: walker.height, lift, reach: sets[0].reach, isFine: quality.isFine, detail: quality.detail,
    time: hasWind ? now / 1000 : 0 };
  const { x, y, yaw, pitch, height } = walker;
  const same = [x.i, x.f, y.i, y.f, yaw, pitch, height, canvas.width, canvas.height, scene.mode, level, world.seed, world.composed].join();
  // A still picture is drawn once.
  if (hasWind || same !== pictured) {
    adapt(now - last);
    drawn = scene.draw(look);
    pictured = same;
  }
  if (!byId("map").hidden && same !== charted && now - chartedAt > MAPPED[Number(scene.isSlow)]) {
    chart.draw(look, scene.mode);
    [charted, chartedAt] = [same, now];
  }
  tell(now);
  requestAnimationFrame(frame);
}

/** Bytes received, seen twice a second over the last two. */
const meter = [];
let updated = 0;

function tell(now) {
  const state = root.dataset.state === "failed" ? "failed" : world.isReady ? "ready" : "loading";
  const isNews = state !== root.dataset.state;
  root.dataset.state = state;
  const words = walker.isAloft && !walker.target ? "Land" : "Fly";
  if (byId("fly").textContent !== words) byId("fly").textContent = words;
  if (now - updated < 500 && !isNews) return;
  updated = now;
  const { loaded, chunks, wanted, received } = world.sums;
  meter.push([now, received]);
  if (meter.length > 5) meter.shift();
  const rate = (1000 * (received - meter[0][1])) / Math.max(1, now - meter[0][0]);
  const number = (value) => value.toLocaleString("en");
  Object.assign(root.dataset, { drawn, level });
  byId("tally").textContent = `${number(drawn)} of ${number(loaded)} points drawn · ${chunks === wanted ? number(chunks) : `${chunks} of ${wanted}`} chunks · `
    + `${bytes(Math.round(rate))}/s · at ${formatPlace(walker.x, 0)}, ${formatPlace(walker.y, 0)}`;
  remember();
}

/** Keeps the place in the address. */
function remember() {
  const turned = (angle) => String(Math.round((angle * 180) / Math.PI));
  const at = [walker.x, walker.y].map((v) => formatPlace(v, 2)).join(",");
  const rest = { fly: walker.isAloft && 1, seed: given.seed !== "7" && given.seed, quality: given.quality ?? false, map: wantsMap && 1 };
  const address = hashOf([["at", at], ["yaw", turned(walker.yaw)], ["pitch", turned(walker.pitch)], ...Object.entries(rest).filter(([, value]) => value !== false)]);
  if (address === location.hash || isScenery) return;
  history.replaceState(null, "", address);
  byId("plane").href = `/${planeHash()}`;
}

/** The plane with the same points around the walker. */
function planeHash() {
  const { rank, ...layer } = layersOf(given.seed)[0];
  return toHash({ ...initial(), x: walker.x, y: walker.y, span: 80, tab: "choose", layers: [{ ...LAYER, ...layer, color: 3 }] });
}

let asked = 0;

/** Shows what stands at a place of the window, or nearest ahead. */
async function pick(at) {
  if (!look) return;
  asked += 1;
  const mine = asked;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const place = at ? [(2 * at[0]) / width - 1, 1 - (2 * at[1]) / height] : [0, -0.1];
  const found = world.pick(look, place, width / height, at ? 0.05 : 0.6);
  if (!found) return close();
  const set = joined(setOf(world.layers[0]));
  const where = [found.x, found.y].map((v) => formatPlace(v, 9)).join(",");
  try {
    const { neighbors } = await askJson(`/v1/nearest?at=${where}&k=1&${set}`);
    if (mine === asked) show(found, neighbors[0], set);
  } catch (error) {
    notice.refused(error);
  }
}

const NAMES = { conifer: "Conifer", broad: "Broad-leaved tree", rock: "Rock", bush: "Bush", tuft: "Grass", flower: "Flowers" };

function show(found, point, set) {
  const card = byId("card");
  const rows = [["id", point.id], ["x", String(point.x)], ["y", String(point.y)], ["size", `${found.size.toFixed(2)} units`]];
  const { size, cx, cy } = found.leaf;
  card.dataset.id = point.id;
  card.replaceChildren(
    make("header", {}, make("h2", {}, NAMES[found.kind]), make("button", { type: "button", "aria-label": "Close", onclick: close }, "✕")),
    make("dl", {}, rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)])),
    make("p", {}, make("a", { href: `/v1/points/${point.id}?${set}` }, "This point by its id"),
      make("a", { href: `/v1/chunks/${size}/${cx}/${cy}?${set}&format=json` }, "Its chunk")),
  );
  card.hidden = false;
}

function close() {
  asked += 1;
  if (byId("card").hidden) return;
  byId("card").hidden = true;
  delete byId("card").dataset.id;
  canvas.focus();
}

/** @type {any} */
let home = null;

/** Goes to where doubles have seven digits fewer left, and back to the same trees: on foot from clearing to clearing. */
function jump() {
  const { x, y, yaw, pitch, isAloft } = walker;
  walker.begin({ yaw, pitch, isAloft, ...home ?? { x: FAR[0], y: FAR[1], isAnywhere: true } });
  home = home ? null : { x, y, yaw, pitch, isAloft };
  byId("jump").textContent = home ? "Jump back" : "Jump far away";
  close();
}

/** Shows the small map, or puts it away. */
function toggleMap(isShown) {
  byId("map").hidden = !isShown;
  byId("chart").setAttribute("aria-pressed", String(isShown));
  charted = "";
}

stick(byId("stick-walk"), (push) => {
  walker.walks = push;
  walker.take();
});
stick(byId("stick-look"), (push) => {
  walker.looks = push;
  walker.take();
});
byId("jump").addEventListener("click", jump);
byId("chart").addEventListener("click", () => toggleMap(byId("map").hidden));
toggleMap(scene.isBlind || matchMedia("(min-width: 46.01rem) and (min-height: 30.01rem)").matches);
byId("fly").addEventListener("click", () => {
  if (walker.isAloft && !walker.target) walker.descend();
  else walker.rise();
});
addEventListener("keydown", (event) => event.key === "Escape" && close());
canvas.addEventListener("webglcontextlost", () => location.reload());
watchTheme(byId("theme"), () => {
  scene.mode = isDark() || isScenery ? "dusk" : "day";
});
addEventListener("hashchange", ({ newURL }) => {
  // The place may have been written into the address since.
  given = fromHash(new URL(newURL).hash);
  walker.begin(given);
  level = given.quality ?? level;
  if (given.seed !== world.seed) {
    world.stop();
    world = new World(scene, given.seed, failed);
  }
});

// For the curious, and for tests.
globalThis.strew = { walker, scene, get world() { return world; }, get look() { return look; }, QUALITIES };
requestAnimationFrame(frame);
