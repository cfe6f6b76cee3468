// The essay: its figures, each on a stage of its own.

import { Argument } from "../argument.js";
import { byId, copy, skipLinks } from "../dom.js";
import { watchTheme } from "../theme.js";
import { Blocks } from "./blocks.js";
import { Chance } from "./chance.js";
import { Row, degrees } from "./dials.js";
import { Found } from "./found.js";
import { Indices } from "./indices.js";
import { Race } from "./race.js";
import { Same } from "./same.js";
import { Seeds } from "./seeds.js";
import { Served } from "./served.js";
import { Stage } from "./stage.js";
import { Vectors } from "./vectors.js";

/** The last place of the row that can be chosen. */
const MOST_PLACE = 1e9;

const root = document.documentElement;
const figures = {
  chance: new Chance(), race: new Race(), row: new Row(), indices: new Indices(), same: new Same(),
  blocks: new Blocks(), vectors: new Vectors(), found: new Found(), seeds: new Seeds(), served: new Served(),
};
const stages = Object.entries(figures).map(([id, figure]) => new Stage(id, figure));
const stageOf = (/** @type {string} */ id) => /** @type {Stage} */ (stages.find((stage) => stage.id === id));

const { race, row, same, blocks, vectors, seeds, served } = figures;

stageOf("race").choices("race-kind", (kind) => race.begin(kind === "together"));
stageOf("same").choices("same-kind", (kind) => same.choose(kind));
stageOf("row").slider("row-angle", (value) => degrees(value / 360), (value) => row.choose(value / 180));
byId("row-place").addEventListener("change", () => {
  const place = Math.min(MOST_PLACE, Math.max(0, Math.floor(Number(byId("row-place").value))));
  if (!Number.isFinite(place)) return;
  stageOf("row").take();
  row.go(place);
  stageOf("row").draw();
});
row.told = (place) => {
  if (document.activeElement !== byId("row-place")) byId("row-place").value = String(place);
};
blocks.slider = stageOf("blocks").slider("blocks-radius", (value) => `${value} step${value === 1 ? "" : "s"}`, (value) => blocks.see(value));
vectors.slider = stageOf("vectors").slider("vectors-share", (value) => `${value} %`, (value) => vectors.set(value / 100));
// Where no motion is wanted the figures are over already.
blocks.slider.set(blocks.radius);
vectors.slider.set(Math.round(100 * vectors.share));

const sliders = {
  density: stageOf("seeds").slider("seeds-density", String, (density) => seeds.choose({ density })),
  warp: stageOf("seeds").slider("seeds-warp", String, (warp) => seeds.choose({ warp })),
};
seeds.follow = ({ density, warp, seed }) => {
  sliders.density.set(density);
  sliders.warp.set(warp);
  byId("seeds-next").textContent = `Next seed (now ${seed})`;
};
byId("seeds-next").addEventListener("click", () => {
  stageOf("seeds").take();
  seeds.choose({ seed: seeds.chosen.seed + 1 });
});
byId("served-far").addEventListener("click", () => served.jump());
byId("served-copy").addEventListener("click", () => copy(byId("served-command"), byId("served-copy")));

/** Has the server's points requested when a figure comes near. */
const argument = new Argument();
const loads = { argument, chance: figures.chance, vectors, served, seeds: { load: () => seeds.go() } };
const near = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    if (!isIntersecting) continue;
    near.unobserve(target);
    loads[target.id].load();
  }
}, { rootMargin: "60% 0px" });
for (const id of Object.keys(loads)) near.observe(byId(id));

watchTheme(byId("theme"), () => [argument, ...stages].forEach((one) => one.themed()));
skipLinks();

// On paper figures are over and light.
let shown;
addEventListener("beforeprint", () => {
  shown = root.dataset.theme;
  root.dataset.theme = "light";
  for (const stage of stages) {
    stage.finish();
    stage.show();
    stage.themed();
  }
});
addEventListener("afterprint", () => {
  if (shown) root.dataset.theme = shown;
  else delete root.dataset.theme;
  for (const stage of stages) stage.themed();
});

// For the curious, and for tests.
globalThis.strew = { figures, stages };
root.dataset.state = "ready";
