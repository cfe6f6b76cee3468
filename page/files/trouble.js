// What keeps the plane from being drawn, said over its middle: a busy server, one that is slow, one that refuses. It goes
// away by itself when the points come.

import { isAway } from "./api.js";
import { byId, icon, make } from "./dom.js";

/** Milliseconds without anything from the server after which it is called slow. */
const PATIENCE = 1200;
/** Milliseconds between looks at what has come. */
const LOOK = 250;

const SIGN = "M12 8v5M12 16.5h.01M12 3 2.5 20h19z";

/** @typedef {[string, () => void][]} Buttons Words and what a click does. */

/** @typedef {{ words?: string, said?: string, buttons?: Buttons }} Message */

export class Trouble {
  /** `isAsking()` says whether the page waits for an answer beside points; `retry()` asks for everything again. */
  constructor(plane, isAsking, retry) {
    this.plane = plane;
    this.isAsking = isAsking;
    this.retry = retry;
    this.refusal = null;
    this.busyUntil = 0;
    this.isBusy = false;
    this.timer = 0;
    this.news = "";
    this.newsAt = 0;
    this.shown = "";
    this.element = byId("trouble");
  }

  /** Something is being loaded: looks whether it comes. */
  watch() {
    if (this.timer) return;
    this.newsAt = performance.now();
    this.timer = setInterval(() => this.look(), LOOK);
  }

  /** The server is busy until a time, in milliseconds as `performance.now` counts them. */
  busy(until) {
    this.busyUntil = until;
    this.isBusy = true;
    this.watch();
    this.look();
  }

  /** The server refuses what is shown: `words`, what it said itself, and buttons, pairs of words and what they do. */
  refuse(words, /** @type {Message} */ { said = "", buttons = [] } = {}) {
    this.refusal = { words, said, buttons };
    this.look();
  }

  /** The refusal is over. */
  clear() {
    Object.assign(this, { refusal: null, busyUntil: 0 });
    this.look();
  }

  /** Shows what there is to say now; ends when nothing is loaded any more. */
  look() {
    const { chunks } = this.plane;
    const now = performance.now();
    const news = `${chunks.received} ${chunks.wanted.filter(({ state }) => state === "done").length}`;
    if (news !== this.news) Object.assign(this, { news, newsAt: now, isBusy: false });
    const isWaiting = chunks.wanted.length === 0 ? this.isAsking() : chunks.wanted.some(({ state }) => state !== "done");
    // While it is asked again it counts as busy, until something comes.
    if (chunks.wanted.some(({ state }) => state === "later") || this.busyUntil > now) this.isBusy = true;
    else if (!isWaiting && !this.isAsking()) this.isBusy = false;
    const until = Math.max(this.busyUntil, chunks.restsUntil);
    if (this.refusal) this.show("refused", this.refusal);
    else if (this.isBusy) {
      this.show("busy", { words: "The server is busy.", buttons: [["Try now", this.retry]] });
      const seconds = Math.ceil((until - now) / 1000);
      const line = this.element.querySelector(".until");
      if (line) line.textContent = seconds > 0 ? `Trying again in ${seconds} s.` : "Trying again now.";
    } else if (isWaiting && !isAway() && now - this.newsAt > PATIENCE) {
      this.show("slow", { words: "The server is slow to answer. The points appear as soon as they come." });
    } else this.show("");
    if (!isWaiting && !this.isBusy && document.documentElement.dataset.state !== "loading") {
      clearInterval(this.timer);
      this.timer = 0;
    }
  }

  /** Fills the box, or takes it away; what is there already stays as it is, so that it is read out once. */
  show(kind, /** @type {Message} */ { words = "", said = "", buttons = [] } = {}) {
    const name = kind && `${kind} ${words} ${said}`;
    if (name === this.shown) return;
    this.shown = name;
    const { element } = this;
    element.hidden = !kind;
    element.dataset.kind = kind;
    if (!kind) return element.replaceChildren();
    element.replaceChildren(
      icon(SIGN), make("div", {}, make("p", {}, words),
        kind === "busy" && make("p", { class: "until", "aria-hidden": "true" }),
        said && make("p", { class: "note" }, said),
        buttons.length > 0 && make("div", { class: "buttons" }, buttons.map(([label, onclick]) => make("button", { type: "button", onclick }, label)))),
    );
  }
}
