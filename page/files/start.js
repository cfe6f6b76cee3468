// The tab Start: links to views, with pictures that were made once (`just pictures`), and three kinds of points side by side,
// drawn when the plane is at rest.

import { ask } from "./api.js";
import { pointPicture } from "./charts.js";
import { byId } from "./dom.js";
import { streamOf } from "./hash.js";
import { initial } from "./state.js";

/** The points of each kind, and how many of them lie along a side. */
const ACROSS = 14;
const COUNT = ACROSS ** 2;

function whiteNoise(seed) {
  return Float64Array.from({ length: 2 * COUNT }, streamOf(seed));
}

function jitteredGrid(seed) {
  const next = streamOf(seed);
  return Float64Array.from({ length: 2 * COUNT }, (_, i) => {
    const cell = i >> 1;
    return ((i % 2 === 0 ? cell % ACROSS : Math.floor(cell / ACROSS)) + next()) / ACROSS;
  });
}

/** As many points of the server: the lowest of a box a little higher than needed. */
async function strewn(seed) {
  const answer = await ask(`/v1/points?bbox=0,0,${ACROSS},${ACROSS + 3}&spacing=1&seed=${seed}&format=f32`);
  const packed = new Float32Array(await answer.arrayBuffer());
  const points = Array.from({ length: packed.length / 2 }, (_, k) => [packed[2 * k], packed[2 * k + 1]]);
  points.sort((a, b) => a[1] - b[1]);
  const height = points[COUNT][1];
  return Float64Array.from(points.slice(0, COUNT).flatMap(([x, y]) => [x / ACROSS, y / height]));
}

/** @type {[string, (seed: number) => any][]} */
const KINDS = [["white", whiteNoise], ["jitter", jitteredGrid], ["strew", strewn]];

export class Start {
  /** `opened()` is called when the plane alone is to be seen. */
  constructor(session, opened) {
    this.session = session;
    this.seed = 1;
    this.isFilled = false;
    this.trio = KINDS.map(([id, make]) => ({ canvas: byId(`kind-${id}`), make, points: new Float64Array(0) }));
    byId("kinds-again").addEventListener("click", () => {
      this.seed += 1;
      this.compare();
    });
    byId("view-plane").addEventListener("click", (event) => {
      event.preventDefault();
      session.choose((state) => Object.assign(state, { ...initial(), tab: "choose" }), "layers", "view", "tab");
      opened();
    });
  }

  /** When the plane has its points, there is time for pictures. */
  rested() {
    if (this.session.state.tab !== "start" || this.isFilled) return;
    this.isFilled = true;
    this.compare();
  }

  opened() {
    if (document.documentElement.dataset.state === "ready") this.rested();
    this.themed();
  }

  themed() {
    if (this.session.state.tab !== "start") return;
    for (const { canvas, points } of this.trio) if (points.length > 0) pointPicture(canvas, points, 1, 1.4);
  }

  async compare() {
    const { seed } = this;
    await Promise.all(this.trio.map(async (one) => {
      const points = await Promise.resolve(one.make(seed)).catch(() => null);
      if (!points || seed !== this.seed) return;
      one.points = points;
      this.themed();
    }));
    document.documentElement.dataset.start = "ready";
  }
}
