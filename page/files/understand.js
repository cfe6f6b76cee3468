// The tab Understand: what the points in view measure, beside what the table was measured to be.

import { ask, askJson, wordsOf } from "./api.js";
import { lineChart, spectrumPicture } from "./charts.js";
import { byId, make, settled, spoken } from "./dom.js";
import { measure } from "./worker.js";
import { joined } from "./query.js";

/** The most points that are measured, from the middle of the view, and no fewer than this. */
const MOST = 14_400;
const LEAST = 100;
/** The side of the window that is the reference, in mean spacings. */
const REFERENCE = 120;

/** The middle of a view as a square, with the points of a layer in it. */
function middleOf(plane, layer, count) {
  const { view } = plane;
  const whole = Math.min(view.width, view.height) * view.unit;
  const expected = (count * whole * whole) / (view.width * view.height * view.unit ** 2);
  const side = whole * Math.min(1, Math.sqrt(MOST / Math.max(1, expected)));
  const found = [];
  plane.each((of, x, y) => {
    if (of === layer && Math.abs(x) < side / 2 && Math.abs(y) < side / 2) found.push(x + side / 2, y + side / 2);
  });
  return { points: Float64Array.from(found), side };
}

/** The measures of a window with the layer's table and warp, as a reference: `{ least, mean }`. */
const references = new Map();
function referenceOf(layer) {
  const pairs = [["alpha", layer.alpha], ["map", layer.map]].filter(([, value]) => value);
  const query = joined([["profile", layer.profile], ...pairs, ["spacing", "1"], ["seed", "1"], ["warp", warpOf(layer)]]);
  if (!references.has(query)) {
    const asked = ask(`/v1/points?bbox=0,0,${REFERENCE},${REFERENCE}&${query}&format=f32`)
      .then((answer) => answer.arrayBuffer())
      .then((packed) => measure(Float64Array.from(new Float32Array(packed)), REFERENCE));
    references.set(query, asked);
    asked.catch(() => references.delete(query));
  }
  return references.get(query);
}

/** The warp of a layer: seed 0 alone has none unless it says so. */
function warpOf({ warp, seed }) {
  return warp || (/^0*$/.test(seed.trim()) ? "off" : "on");
}

/** The recorded figures of a layer's table. */
export function recordedOf(layer) {
  const pairs = [["alpha", layer.alpha], ["map", layer.map]].filter(([, value]) => value);
  return askJson(`/v1/profiles/${encodeURIComponent(layer.profile)}${pairs.length ? "?" : ""}${joined(pairs)}`);
}

/** The least distance of densest packing, in mean spacings: reports of tables have distances as shares of it. */
export const HEXAGONAL = Math.sqrt(2 / Math.sqrt(3));

/** The figure of a name, of the first window that the table was measured on. */
export function figureOf(recorded, name) {
  const { figures } = recorded.table.provenance;
  const from = figures.find((one) => one.subject.startsWith("window")) ?? figures.at(-1);
  return from?.values[name];
}

export class Understand {
  constructor(session, plane) {
    this.session = session;
    this.plane = plane;
    this.layer = 0;
    /** @type {any} */
    this.drawn = null;
    this.again = settled(200, () => this.measure());
    this.picker = byId("measured-layer");
  }

  get isOpen() {
    return this.session.state.tab === "understand";
  }

  opened() {
    if (this.isOpen) this.rested();
  }

  shown(layers) {
    this.moved();
    this.layer = Math.min(this.layer, layers.length - 1);
    this.picker.hidden = layers.length < 2;
    this.picker.replaceChildren(...layers.map((layer, i) => make("button", {
      type: "button",
      "aria-pressed": String(i === this.layer),
      onclick: () => {
        this.layer = i;
        this.shown(layers);
        this.again();
      },
    }, `${i + 1} ${layer.profile}`)));
  }

  moved() {
    document.documentElement.dataset.measured = "";
  }

  rested() {
    if (this.isOpen) this.again();
  }

  themed() {
    if (this.drawn) this.draw();
  }

  async measure() {
    // A window that is partly loaded is not measured: this is called again when all of it is there.
    if (!this.isOpen || !this.plane.sheets.front?.isFull) return;
    const mine = (this.turn = (this.turn ?? 0) + 1);
    const layer = this.plane.look.layers[this.layer];
    let count = 0;
    this.plane.each((of) => (count += of === this.layer ? 1 : 0));
    const { points, side } = middleOf(this.plane, this.layer, count);
    const area = this.plane.view.width * this.plane.view.height * this.plane.view.unit ** 2;
    if (points.length / 2 < LEAST) {
      this.say(`${points.length / 2} points are too few to measure: zoom out until there are ${LEAST}.`);
      byId("measures").replaceChildren();
      byId("charts").hidden = true;
      document.documentElement.dataset.measured = "too-few";
      return;
    }
    try {
      const [measured, recorded, reference] = await Promise.all([measure(points, side), recordedOf(layer), referenceOf(layer)]);
      if (mine !== this.turn) return;
      this.drawn = { measured, recorded, reference: reference.figures, isWarped: warpOf(layer) !== "off", count, density: count / area, thinned: this.plane.keep < 1 };
      this.draw();
      document.documentElement.dataset.measured = String(measured.figures.count);
    } catch (error) {
      if (mine === this.turn) this.say(`Not measured: ${wordsOf(error)}`);
    }
  }

  say(words) {
    byId("measured-note").textContent = words;
  }

  draw() {
    const { measured, recorded, reference, isWarped, count, density, thinned } = this.drawn;
    const { figures, radial, rdf, image, cells } = measured;
    byId("charts").hidden = false;
    const entry = (words, value, table) => make("div", {}, make("dt", {}, words), make("dd", {}, value, table === undefined ? "" : make("small", { class: "soft" }, ` ${isWarped ? "table, warped" : "table"} ${spoken(table, 3)}`)));
    byId("measures").replaceChildren(
      entry("Points measured", figures.count.toLocaleString("en")),
      entry(thinned ? "Density of those drawn" : "Density", spoken(density, 4)),
      entry("Least distance", spoken(figures.least, 3), reference.least),
      entry("Mean distance", spoken(figures.mean, 3), reference.mean),
    );
    const part = figures.count < count ? "Measured in the middle of the view. " : "";
    const note = thinned ? "What is in view is thinned, so it is not what the table was made for. " : "";
    this.say(`${part}${note}Distances are those to the nearest neighbor, in mean spacings; a honeycomb has 1.07.`);
    const table = recorded.measured.radial.values.map(([nu, power]) => [nu, power]);
    lineChart(byId("radial"), radial, { beside: table });
    lineChart(byId("rdf"), rdf, { beside: recorded.measured.rdf.values, end: 5, name: "r" });
    spectrumPicture(byId("spectrum"), image, cells);
  }
}
