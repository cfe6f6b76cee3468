// What a page says above its picture: one box with the first of what there is to say. It looks four times a second, while
// something is loading, whether that comes, and says so where the server is busy or slow.

import { Gone, Problem, hasKey, onPresence } from "./api.js";
import { byId, make } from "./dom.js";
import { keyForm } from "./form.js";

const AWAY = "The server does not answer. This page tries again by itself.";
const BUSY = "The server is busy.";
const SLOW = "The server is slow to answer. The points appear as soon as they come.";
/** Milliseconds without anything from the server after which it is called slow, and between looks at what has come. */
const PATIENCE = 1200;
const LOOK = 250;

/** What can be said, the most pressing first. */
const SUBJECTS = /** @type {const} */ (["away", "refused", "busy", "wrong", "blind"]);

/** @typedef {typeof SUBJECTS[number]} Subject */
/** @typedef {[string, () => void][]} Buttons Words and what a click does. */
/** @typedef {{ note?: string, buttons?: Buttons }} Further What is said below, and what can be done about it. */
/** @typedef {{ chunks: import("./chunks.js").Chunks, isAsking?: () => boolean }} Awaited Points, and whether they wait for another answer. */

export class Notice {
  /** @type {Partial<Record<Subject, { words: string | Error } & Further>>} */
  said = {};
  /** @type {Awaited | null} */
  awaited = null;
  busyUntil = 0;
  isBusy = false;
  timer = 0;
  news = "";
  newsAt = 0;

  /** `retry()` requests again what was refused; `back()` is called when a server that was away is back. */
  constructor(/** @type {HTMLElement} */ box, /** @type {() => void} */ retry, back = retry) {
    this.box = box;
    this.retry = () => {
      this.say("refused", null);
      retry();
    };
    onPresence((gone) => {
      this.say("away", gone ? AWAY : null);
      if (!gone) back();
    });
  }

  /** Says something of a subject; `null` takes it away. What is refused can be tried again, what is wrong is closed. */
  say(/** @type {Subject} */ subject, /** @type {string | Error | null} */ words, /** @type {Further} */ { note, buttons } = {}) {
    const usual = /** @type {Record<string, Buttons>} */ ({
      refused: [["Try again", this.retry]], wrong: [["Close", () => this.say("wrong", null)]],
    });
    this.said[subject] = words ? { words, note, buttons: buttons ?? usual[subject] ?? [] } : undefined;
    this.show();
  }

  /** Says what the server refused. That it is away is said by itself. */
  refused(/** @type {any} */ error) {
    if (!(error instanceof Gone)) this.say("refused", error);
  }

  /** Nothing is refused any more, and the server not known to be busy. */
  clear() {
    this.busyUntil = 0;
    this.say("refused", null);
  }

  show() {
    const { box } = this;
    const kind = SUBJECTS.find((one) => this.said[one]);
    const { words = "", note, buttons = [] } = (kind && this.said[kind]) ?? {};
    const text = words instanceof Error ? words.message : words;
    // What is read out already, and what is being typed, stays.
    const name = JSON.stringify([kind, text, note, buttons]);
    if (name === this.shown) return;
    this.shown = name;
    box.hidden = !kind;
    box.dataset.kind = kind ?? "";
    if (words instanceof Problem && words.isLocked) {
      box.replaceChildren(hasKey() ? text : "This server needs a key. It is kept in this tab only.", keyForm(this.retry));
      byId("key").focus();
      return;
    }
    box.replaceChildren(text, kind === "busy" ? make("p", { class: "until", "aria-hidden": "true" }) : "", note ? make("p", { class: "note" }, note) : "",
      make("div", {}, buttons.map(([label, onclick]) => make("button", { type: "button", onclick }, label))));
  }

  /** Something is being loaded: looks whether it comes. */
  watch() {
    if (this.timer) return;
    this.newsAt = performance.now();
    this.timer = setInterval(() => this.look(), LOOK);
  }

  /** The server is busy until a time, in milliseconds as `performance.now` counts them. */
  busy(/** @type {number} */ until) {
    Object.assign(this, { busyUntil: until, isBusy: true });
    this.watch();
    this.look();
  }

  /** Says what there is to say of what is awaited; ends when nothing is any more. */
  look() {
    if (!this.awaited) return;
    const { chunks, isAsking = () => false } = this.awaited;
    const now = performance.now();
    const { received, done, wanted, isLater } = chunks.sums;
    const news = `${received} ${done}`;
    if (news !== this.news) Object.assign(this, { news, newsAt: now, isBusy: false });
    const isWaiting = wanted === 0 ? isAsking() : done < wanted;
    // While it is asked again it counts as busy, until something comes.
    if (isLater || this.busyUntil > now) this.isBusy = true;
    else if (!isWaiting && !isAsking()) this.isBusy = false;
    const isSlow = isWaiting && now - this.newsAt > PATIENCE;
    this.say("busy", this.isBusy ? BUSY : isSlow ? SLOW : null, { buttons: this.isBusy ? [["Try now", this.retry]] : [] });
    const line = this.box.querySelector(".until");
    const seconds = Math.ceil((Math.max(this.busyUntil, chunks.restsUntil) - now) / 1000);
    if (line && this.isBusy) line.textContent = seconds > 0 ? `Trying again in ${seconds} s.` : "Trying again now.";
    if (!isWaiting && !this.isBusy && document.documentElement.dataset.state !== "loading") {
      clearInterval(this.timer);
      this.timer = 0;
    }
  }
}
