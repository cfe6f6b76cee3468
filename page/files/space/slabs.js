// Three slabs seen from above, each one mean spacing thick: of the volume, of white noise, of a Poisson disk set in
// space; with the distances of the points in space.

import { ask, isAborted } from "../api.js";
import { contextOf, make } from "../dom.js";
import { formatPlace, moved } from "../place.js";
import { callsOf } from "../worker.js";
import { parametersOf } from "./volume.js";

/** The box that is measured, in mean spacings, and what around its inside are neighbors only. */
const SIDES = [24, 24, 9];
const MARGIN = 2;
const SIDE = SIDES[0] - 2 * MARGIN;
/** Half of a dot's width in mean spacings. */
const RADIUS = 0.15;

const METHODS = [
  { id: "strew", name: "Strew", words: "From the server, around the place in the view." },
  { id: "white", name: "White noise", words: "By chance, made in this page." },
  { id: "poisson", name: "Poisson disk", words: "Bridson's method, made in this page; a box has to be built as a whole." },
];

const call = callsOf("/page/space/worker.js");

export class Slabs {
  /** @param {HTMLElement} list */
  constructor(list) {
    /** The seed of the sets that this page made. */
    this.seed = "";
    /** @type {AbortController | null} */
    this.abort = null;
    this.all = METHODS.map(({ id, name, words }) => {
      const canvas = make("canvas", { id: `slab-${id}`, role: "img" });
      const [least, mean] = [make("dd"), make("dd")];
      list.append(make("figure", {}, canvas, make("figcaption", {}, make("h3", {}, name),
        make("dl", {}, make("div", {}, make("dt", {}, "Minimum distance"), least), make("div", {}, make("dt", {}, "Mean distance"), mean)),
        make("p", { class: "note" }, words))));
      return { id, name, canvas, least, mean, points: null };
    });
    this.turn = 0;
    for (const { canvas } of this.all) new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Makes or requests all of them; throws what the server refuses. */
  async show(state) {
    this.turn += 1;
    const mine = this.turn;
    const others = this.seed === state.seed ? [] : this.all.slice(1).map((one) => this.make(one, state.seed));
    this.seed = state.seed;
    this.abort?.abort();
    this.abort = new AbortController();
    try {
      const points = await requested(state, this.abort.signal);
      const made = await call({ sides: SIDES, margin: MARGIN, points });
      if (mine === this.turn) this.take(this.all[0], made);
    } catch (error) {
      if (!isAborted(error)) throw error;
    }
    await Promise.all(others);
    if (mine === this.turn) document.documentElement.dataset.slabs = state.at.map((one) => one.i).join();
  }

  async make(one, seed) {
    const small = Number(BigInt(seed) % 2n ** 32n);
    this.take(one, await call({ method: one.id, seed: small, sides: SIDES, margin: MARGIN }));
  }

  take(one, { points, distances: { least, mean } }) {
    one.points = points;
    one.least.textContent = least.toFixed(2);
    one.mean.textContent = mean.toFixed(2);
    this.draw();
  }

  draw() {
    for (const one of this.all) this.drawOne(one);
  }

  drawOne({ canvas, points, name }) {
    const side = Math.round(canvas.clientWidth * Math.min(2, devicePixelRatio));
    if (!points || side === 0) return;
    Object.assign(canvas, { width: side, height: side });
    const context = contextOf(canvas);
    context.fillStyle = getComputedStyle(canvas).color;
    const zoom = side / SIDE;
    let count = 0;
    for (let p = 0; p < points.length; p += 3) {
      const [x, y] = [points[p] - MARGIN, SIDE - (points[p + 1] - MARGIN)];
      if (Math.abs(points[p + 2] - SIDES[2] / 2) >= 0.5 || Math.abs(x - SIDE / 2) > SIDE / 2 + RADIUS) continue;
      context.beginPath();
      context.arc(x * zoom, y * zoom, RADIUS * zoom, 0, 7);
      context.fill();
      count += x >= 0 && x < SIDE && y >= 0 && y < SIDE ? 1 : 0;
    }
    canvas.setAttribute("aria-label", `${name}: ${count} points of a slab, seen from above`);
  }
}

/** The server's points in the box around the place of a state, from the box's corner in mean spacings. */
async function requested(state, signal) {
  const unit = Number(state.spacing);
  const low = state.at.map((one, axis) => moved(one, (-SIDES[axis] / 2) * unit));
  const high = state.at.map((one, axis) => moved(one, (SIDES[axis] / 2) * unit));
  const box = [...low, ...high].map((one) => formatPlace(one)).join(",");
  const answer = await ask(`/v1/space/points?bbox=${box}&${parametersOf(state)}&format=f32`, { signal });
  // Coordinates are relative to the box's corner.
  const floats = new Float32Array(await answer.arrayBuffer());
  return Float64Array.from(floats, (v) => v / unit);
}
