// The argument in one picture: a square far from the origin, and what Strew and Poisson disk have to make to show it.

import { ask, wordsOf } from "./api.js";
import { pointPicture } from "./charts.js";
import { large, lasting, upTo } from "./compare/methods.js";
import { byId, settled } from "./dom.js";
import { place } from "./place.js";

/** The side of the square, in mean spacings. */
const SIDE = 20;
/** The seconds that Poisson disk takes for a point here; the page Compare measures them. */
const EACH = 1e-6;

export class Argument {
  points = new Float32Array(0);
  turn = 0;

  constructor() {
    const later = settled(150, () => this.load());
    byId("argument-far").addEventListener("input", () => {
      this.tell();
      later();
    });
    this.tell();
  }

  get at() {
    return 10 ** Number(byId("argument-far").value);
  }

  /** Says what Poisson disk makes first: all points up to there. */
  tell() {
    const first = upTo({ x: place(this.at), y: place(this.at), width: SIDE, height: SIDE });
    byId("argument-at").textContent = this.at.toLocaleString("en");
    byId("argument-first").textContent = `${large(first)} points`;
    byId("argument-lasts").textContent = `come first: ${lasting(first * EACH)} at a millionth of a second each`;
  }

  /** Requests the points of Strew, and says how long that took. */
  async load() {
    const { at } = this;
    const mine = (this.turn += 1);
    const began = performance.now();
    try {
      const answer = await ask(`/v1/points?bbox=${[at, at, at + SIDE, at + SIDE]}&spacing=1&seed=7&format=f32`);
      const points = new Float32Array(await answer.arrayBuffer());
      if (mine !== this.turn) return;
      this.points = points;
      byId("argument-made").textContent = `${points.length / 2} points`;
      byId("argument-took").textContent = `made and sent in ${Math.ceil(performance.now() - began)} ms`;
      this.themed();
    } catch (error) {
      byId("argument-took").textContent = wordsOf(error);
    }
  }

  themed() {
    if (this.points.length > 0) pointPicture(byId("argument-strew"), this.points, SIDE);
  }
}
