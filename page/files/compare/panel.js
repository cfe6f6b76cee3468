// One method: its points, what had to be made for them, and what they measure.

import { lineChart, spectrumPicture } from "../charts.js";
import { make } from "../dom.js";
import { measure } from "../worker.js";
import { Painter } from "../painter.js";
import { distance } from "../place.js";
import { Sheets } from "../sheets.js";
import { LAYER } from "../state.js";
import { themeColor, themeNumbers } from "../theme.js";
import { sized } from "../view.js";
import { MEASURED, large, priceOf } from "./methods.js";
import { Source, windowAround } from "./sources.js";

export class Panel {
  constructor(method, { changed, failed }) {
    this.method = method;
    this.changed = changed;
    this.isOutside = false;
    const { id, name, words, source } = method;
    this.source = new Source(id, changed, failed);
    const canvas = (label, attributes = {}) => make("canvas", { role: "img", "aria-label": `${label} of ${name}`, ...attributes });
    this.plane = canvas("Points", {
      id: `plane-${id}`, class: "plane", tabindex: "0", role: "application", "aria-describedby": "plane-help",
    });
    this.painter = new Painter(this.plane);
    this.sheets = new Sheets(this.painter, this.source.chunks);
    this.outside = make("p", { class: "outside", hidden: true }, "No points here: the window is outside of its region.");
    this.spectrum = canvas("Spectrum", { class: "spectrum" });
    this.radial = canvas("Radial power", { class: "radial" });
    this.none = make("p", { class: "note", hidden: true }, `Not measured here: the square of ${MEASURED} × ${MEASURED} reaches past its region.`);
    this.figures = Object.fromEntries(["least", "mean", "count"].map((key) => [key, make("dd", { id: `${key}-${id}` }, "…")]));
    this.price = { made: make("b", { id: `made-${id}` }, "…"), words: make("span", { id: `price-${id}` }), why: make("p", { class: "why", id: `why-${id}` }) };
    const row = (words, key) => make("div", {}, make("dt", {}, words), this.figures[key]);
    this.element = make("article", { id: `method-${id}`, "aria-labelledby": `name-${id}` },
      make("h2", { id: `name-${id}` }, name),
      make("div", { class: "frame" }, this.plane, this.outside),
      make("div", { class: "price" }, make("p", {}, this.price.made, " ", this.price.words), this.price.why),
      make("div", { class: "spectra" }, make("div", { class: "frame" }, this.spectrum, this.none), this.radial),
      make("dl", {}, row("Minimum distance", "least"), row("Mean distance", "mean"), row("Points", "count")),
      make("p", { class: "words" }, words, " ", make("cite", {}, source)));
  }

  /** Takes the seed and Strew's profile. */
  use(choice) {
    this.source.use(choice);
    this.isReady = true;
    this.themed();
    this.isMeasured = false;
  }

  /** Other colors, or other points: all is painted again. */
  themed() {
    this.look = { layers: [{ ...LAYER, dot: 1.25 }], spacings: [1], spacing: 1, colors: [themeNumbers("ink")], ground: themeNumbers("sunken") };
    this.sheets.renew(false);
  }

  /** Draws the points around a view. */
  draw(view) {
    if (!this.isReady) return;
    const { box } = this.method;
    sized(this.plane, view.pixels);
    if (this.sheets.frame(view, this.look, false)) this.changed();
    if (box) this.edge(box, view);
    const half = [view.width * view.unit / 2, view.height * view.unit / 2];
    const from = box?.map((v, i) => distance({ i: v, f: 0 }, [view.x, view.y][i % 2]));
    this.isOutside = Boolean(from) && !(from[0] < half[0] && from[1] < half[1] && from[2] > -half[0] && from[3] > -half[1]);
    this.outside.hidden = !this.isOutside;
    this.say(view);
  }

  /** Shades what lies outside of the region, and draws its edge. */
  edge(box, view) {
    const { context } = this.painter;
    const pixel = view.unit / view.ratio;
    const [width, height] = view.pixels;
    const within = (v, side) => Math.min(side + 4, Math.max(-4, v));
    const [left, low, right, top] = box.map((v, i) => {
      const at = distance({ i: v, f: 0 }, [view.x, view.y][i % 2]) / pixel;
      return i % 2 === 0 ? within(width / 2 + at, width) : within(height / 2 - at, height);
    });
    context.fillStyle = themeColor("outside");
    context.beginPath();
    context.rect(0, 0, width, height);
    context.rect(left, top, right - left, low - top);
    context.fill("evenodd");
    context.strokeStyle = themeColor("accent");
    context.lineWidth = 1.5 * view.ratio;
    context.setLineDash([6 * view.ratio, 4 * view.ratio]);
    context.strokeRect(left, top, right - left, low - top);
    context.setLineDash([]);
  }

  /** Says what has to be made for a view. */
  say(view) {
    const window = windowAround(view, view.width * view.unit, view.height * view.unit);
    let seen = 0;
    this.sheets.around(view, [0, 0], [window.width / 2, window.height / 2], () => (seen += 1));
    // Nothing is said of points that are still on their way.
    const { made, words, why } = seen === 0 && !this.isOutside ? { words: "", why: "" } : priceOf(this.method.id, window, {
      seen, total: this.source.total, isOutside: this.isOutside, nanoseconds: this.source.nanoseconds,
    });
    for (const [key, text] of Object.entries({ made: made === undefined ? "…" : large(made), words, why })) {
      if (this.price[key].textContent !== text) this.price[key].textContent = text;
    }
  }

  /** Measures the square around a place; `isLatest()` says whether that is still wanted. */
  async measure(at, isLatest) {
    const points = await this.source.square(at);
    if (!isLatest()) return;
    this.measured = points && points.length > 0 ? await measure(points, MEASURED) : null;
    this.isMeasured = true;
    if (!isLatest()) return;
    const { least, mean, count } = this.measured?.figures ?? {};
    this.figures.least.textContent = least?.toFixed(3) ?? "–";
    this.figures.mean.textContent = mean?.toFixed(3) ?? "–";
    this.figures.count.textContent = count?.toLocaleString("en") ?? "–";
    this.element.dataset.measured = String(count ?? "outside");
    this.none.hidden = Boolean(this.measured);
  }

  /** The curve of radial power, once it is measured. */
  get curve() {
    return this.isMeasured ? (this.measured?.radial ?? []) : undefined;
  }

  /** Draws what was measured, up to a power; `reference` is the curve that is drawn dashed beside. */
  chart(top, reference) {
    const { image, cells, radial } = this.measured ?? { image: new Float32Array(1), cells: 1, radial: [] };
    spectrumPicture(this.spectrum, image, cells);
    lineChart(this.radial, radial, { beside: reference === radial ? [] : reference, top, aspect: 0.55 });
  }
}
