// One method: its points, what had to be made for them, and what they measure.

import { lineChart, spectrumPicture } from "../charts.js";
import { contextOf, make } from "../dom.js";
import { MOST_NU } from "../spectrum.js";
import { measure } from "../measure.js";
import { distance } from "../place.js";
import { themeColor } from "../theme.js";
import { MEASURED } from "./methods.js";
import { large, priceOf } from "./price.js";
import { Sheet } from "./sheet.js";
import { Asked, Made, windowAround } from "./sources.js";

/**
 * A source of no points.
 * @type {{ version: string, runs: (view: any) => object[] }}
 */
const NOTHING = { version: "none", runs: () => [] };

export class Panel {
  constructor(method, { changed, failed }) {
    this.method = method;
    this.changed = changed;
    this.failed = failed;
    this.isOutside = false;
    /** The window whose points are drawn alone, and these. */
    this.aloneKey = "";
    this.aloneSource = NOTHING;
    const { id, name, words, source } = method;
    this.source = id === "strew" ? new Asked(changed, failed) : new Made(id, changed, failed);
    const canvas = (label, attributes = {}) => make("canvas", { role: "img", "aria-label": `${label} of ${name}`, ...attributes });
    this.plane = canvas("Points", {
      id: `plane-${id}`, class: "plane", tabindex: "0", role: "application", "aria-describedby": "plane-help",
    });
    this.sheet = new Sheet(this.plane, method.box);
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
    this.sheet.renew();
    this.isMeasured = false;
  }

  /** Draws the points around a view; with a window, only what has to be made for it. */
  draw(view, alone) {
    if (!this.isReady) return;
    if (alone) return this.drawAlone(view, alone);
    this.source.cover(view);
    this.sheet.draw(view, this.source);
    const { box } = this.method;
    if (box) {
      const half = [view.width * view.unit / 2, view.height * view.unit / 2];
      const from = box.map((v, i) => distance({ i: v, f: 0 }, [view.x, view.y][i % 2]));
      this.isOutside = !(from[0] < half[0] && from[1] < half[1] && from[2] > -half[0] && from[3] > -half[1]);
      this.outside.hidden = !this.isOutside;
    }
    this.say(view);
  }

  /** Draws what has to be made for a window. */
  drawAlone(view, { window, unit }) {
    const key = [window.x.i, window.x.f, window.y.i, window.y.f, window.width, window.height, this.source.seed].join();
    if (this.aloneKey !== key) {
      this.aloneKey = key;
      this.aloneSource = NOTHING;
      this.source.alone(window).then((run) => {
        if (this.aloneKey !== key) return;
        this.aloneSource = { version: key, runs: ({ x, y }) => [{ ...run, left: distance(run.x, x), low: distance(run.y, y) }] };
        this.changed();
      }, (error) => this.failed(error));
    }
    this.sheet.draw({ ...view, unit }, this.aloneSource);
    // The window that is wanted.
    const [width, height] = [window.width, window.height].map((side) => (side / unit) * view.ratio);
    const context = contextOf(this.plane);
    context.strokeStyle = themeColor("accent");
    context.lineWidth = 2 * view.ratio;
    context.strokeRect((this.plane.width - width) / 2, (this.plane.height - height) / 2, width, height);
  }

  /** Says what has to be made for a view. */
  say(view) {
    const window = windowAround(view, view.width * view.unit, view.height * view.unit);
    let seen = 0;
    for (const { points, count, stride, left, low } of this.source.runs(view)) {
      for (let p = 0; p < count * stride; p += stride) {
        seen += Number(2 * Math.abs(points[p] + left) < window.width && 2 * Math.abs(points[p + 1] + low) < window.height);
      }
    }
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
    const beside = reference && reference !== radial ? [{ values: reference, color: "soft", dash: true }] : [];
    lineChart(this.radial, {
      series: [...beside, { values: radial, color: "accent" }], x: [0, MOST_NU], y: [0, top], name: "ν", aspect: 0.55,
    });
  }
}
