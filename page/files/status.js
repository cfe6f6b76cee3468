// The line at the bottom: how many points are in view, where, and how long a stretch of it is.

import { Problem, askJson, isAborted } from "./api.js";
import { byId, counted, settled, spoken } from "./dom.js";
import { decimalsFor, formatPlace } from "./place.js";
import { askedOf, boxOf } from "./query.js";

/** The exact number of points in a box of four decimals; `keep` thins it. */
export async function countIn(layers, box, keep, signal) {
  const { query, body } = askedOf(layers, box, keep);
  return Number((await askJson(`/v1/count${query}`, { body, signal })).count);
}

export class Status {
  constructor(session, plane) {
    this.session = session;
    this.plane = plane;
    /** @type {number | null} */
    this.count = null;
    /** How many points there would be without thinning. */
    this.all = 0;
    this.abort = null;
    this.ask = settled(200, () => this.tally());
  }

  /** The view has moved, or other points are shown. */
  moved() {
    const { view } = this.plane;
    const decimals = decimalsFor(view.unit);
    byId("where").textContent = `${formatPlace(view.x, decimals)}, ${formatPlace(view.y, decimals)}`;
    this.scale(view);
    this.count = null;
    document.documentElement.dataset.count = "";
    this.ask();
  }

  /** A stretch of a round length, up to a hundred pixels. */
  scale({ unit }) {
    const most = 100 * unit;
    const ten = 10 ** Math.floor(Math.log10(most));
    const length = ([5, 2].find((n) => n * ten <= most) ?? 1) * ten;
    const [line, words] = /** @type {HTMLCollectionOf<HTMLElement>} */ (byId("ruler").children);
    line.style.width = `${length / unit}px`;
    words.textContent = spoken(length, 1);
  }

  /** Something that was chosen cannot be shown. */
  refused() {
    byId("tally").textContent = "Check the field marked red";
  }

  async tally() {
    const { plane, session } = this;
    if (!plane.look) return;
    this.abort?.abort();
    clearTimeout(this.later);
    this.abort = new AbortController();
    const { keep } = plane;
    // The server refuses to count so many points in a field, but only after a while: it is not asked.
    if (plane.isGray && session.state.layers.some(({ field }) => field)) return this.say(keep, { status: 413 });
    try {
      const box = boxOf(plane.view);
      const { layers } = session.state;
      const { signal } = this.abort;
      const shown = await countIn(layers, box, keep, signal);
      this.all = keep < 1 ? await countIn(layers, box, 1, signal) : shown;
      this.count = shown;
      this.say(keep);
    } catch (error) {
      if (isAborted(error)) return;
      this.say(keep, error);
      if (error instanceof Problem && error.isPassing) this.later = setTimeout(() => this.tally(), Math.max(1, error.retryAfter) * 1000);
    }
  }

  say(keep, error) {
    const words = () => {
      if (error?.faults?.length > 0) return "Check the field marked red";
      if (error?.isPassing) return "Counted when the server has time";
      if (error?.status === 413) return `Too many points in view to count${this.plane.isGray ? ": gray shows how dense they are" : ""}`;
      if (error) return "Not counted";
      if (this.plane.isGray) return `${counted(this.all)} in view, too many to draw: gray shows how dense they are`;
      if (keep < 1) {
        const rest = Math.round(1 / keep).toLocaleString("en");
        return `${counted(this.all)} in view, too many to draw; shown: one in ${rest}, those of lowest rank`;
      }
      if (this.count === 0 && this.plane.span < 4 * this.plane.look.spacing) {
        return `No points in view: they are about ${spoken(this.plane.look.spacing, 2)} apart, zoom out`;
      }
      return `${counted(this.count ?? 0)} in view`;
    };
    byId("tally").textContent = words();
    document.documentElement.dataset.count = error ? "" : String(this.count);
  }
}
