// One method: its points, and below them what they measure.

import { lineChart, spectrumPicture } from "../charts.js";
import { make, spoken } from "../dom.js";
import { MOST_NU } from "../spectrum.js";
import { measure } from "../measure.js";
import { distance } from "../place.js";
import { MEASURED } from "./methods.js";
import { Sheet } from "./sheet.js";
import { Asked, Made } from "./sources.js";

/** Nanoseconds as people say them. */
function time(nanoseconds) {
  if (!Number.isFinite(nanoseconds)) return "–";
  return nanoseconds < 1000 ? `${spoken(nanoseconds, 2)} ns` : `${spoken(nanoseconds / 1000, 2)} µs`;
}

export class Panel {
  constructor(method, { changed, failed }) {
    this.method = method;
    this.isTimed = false;
    const { id, name, far, words, source } = method;
    this.source = id === "strew" ? new Asked(changed, failed) : new Made(id, changed, failed);
    const canvas = (label, attributes = {}) => make("canvas", { role: "img", "aria-label": `${label} of ${name}`, ...attributes });
    this.plane = canvas("Points", {
      id: `plane-${id}`, class: "plane", tabindex: "0", role: "application", "aria-describedby": "plane-help",
    });
    this.sheet = new Sheet(this.plane, method.box);
    this.outside = make("p", { class: "outside", hidden: true }, "No points here: outside of its region.");
    this.spectrum = canvas("Spectrum", { class: "spectrum" });
    this.radial = canvas("Radial power", { class: "radial" });
    this.none = make("p", { class: "note", hidden: true }, `Not measured here: the square of ${MEASURED} × ${MEASURED} reaches past its region.`);
    this.figures = Object.fromEntries(["least", "mean", "count", "time"].map((key) => [key, make("dd", { id: `${key}-${id}` }, "…")]));
    this.timing = make("dd", { class: "timing", id: `timing-${id}` });
    const row = (words, key, ...more) => make("div", {}, make("dt", {}, words), this.figures[key], more);
    this.element = make("article", { id: `method-${id}`, "aria-labelledby": `name-${id}` },
      make("h2", { id: `name-${id}` }, name),
      make("div", { class: "frame" }, this.plane, this.outside),
      make("div", { class: "frame" }, this.spectrum, this.none), this.radial,
      make("dl", {}, row("Least distance", "least"), row("Mean distance", "mean"), row("Points", "count"),
        row("Time a point", "time", this.timing)),
      make("p", { class: "far" }, far),
      make("p", { class: "words" }, words, " ", make("cite", {}, source)));
  }

  /** Takes the seed and Strew's profile. */
  use(choice) {
    this.source.use(choice);
    this.isReady = true;
    this.sheet.renew();
    this.isMeasured = false;
  }

  draw(view) {
    if (!this.isReady) return;
    this.source.cover(view);
    this.sheet.draw(view, this.source);
    const { box } = this.method;
    if (!box) return;
    const half = [view.width * view.unit / 2, view.height * view.unit / 2];
    const from = box.map((v, i) => distance({ i: v, f: 0 }, [view.x, view.y][i % 2]));
    this.outside.hidden = from[0] < half[0] && from[1] < half[1] && from[2] > -half[0] && from[3] > -half[1];
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

  /** Times the method, once for each choice. */
  async time() {
    const { nanoseconds, built, answer } = await this.source.time();
    this.figures.time.textContent = time(nanoseconds);
    if (answer) {
      this.timing.textContent = `over the wire: ${answer.count.toLocaleString("en")} points in ${spoken(answer.milliseconds, 2)} ms, latency and reading included`;
    } else if (this.method.box) this.timing.textContent = `in this browser: all of its region, built in ${spoken(built, 2)} ms`;
    else if (built) this.timing.textContent = `in this browser, after ${spoken(built, 2)} ms for the tile`;
    else this.timing.textContent = "in this browser, for any window alone";
  }
}
