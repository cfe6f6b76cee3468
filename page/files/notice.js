// What a page says above its picture: one box with the first of what there is to say.

import { Gone, Problem, hasKey, onPresence } from "./api.js";
import { byId, make } from "./dom.js";
import { keyForm } from "./form.js";

const AWAY = "The server does not answer. This page tries again by itself.";
/** What can be said, the most pressing first. */
const SUBJECTS = /** @type {const} */ (["away", "busy", "refused", "wrong", "blind"]);

/** The button that takes away what is wrong. */
const CLOSE = (/** @type {Notice} */ notice) => /** @type {[string, () => void][]} */ ([["Close", () => notice.say("wrong", null)]]);

export class Notice {
  /** @type {Partial<Record<typeof SUBJECTS[number], string | Error | null>>} */
  said = {};
  /** What can be done about what is wrong: words and what a click does. */
  buttons = /** @type {[string, () => void][]} */ ([]);

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

  /** Says something of a subject; `null` takes it away. What is wrong comes with buttons, or one that closes it. */
  say(/** @type {typeof SUBJECTS[number]} */ subject, /** @type {string | Error | null} */ words, buttons = CLOSE(this)) {
    if (subject === "wrong") this.buttons = buttons;
    this.said[subject] = words;
    const { box } = this;
    const first = SUBJECTS.find((one) => this.said[one]);
    const said = first && this.said[first];
    box.hidden = !said;
    const text = said instanceof Error ? said.message : said ?? "";
    const isLocked = said instanceof Problem && said.isLocked;
    const shown = first === "refused" ? [["Try again", this.retry]] : first === "wrong" ? this.buttons : [];
    // What is read out already, and what is being typed, stays.
    const name = JSON.stringify([text, shown]);
    if (name === this.shown) return;
    this.shown = name;
    if (isLocked) {
      box.replaceChildren(hasKey() ? text : "This server needs a key. It is kept in this tab only.", keyForm(this.retry));
      byId("key").focus();
    } else box.replaceChildren(text, make("div", {}, shown.map(([label, onclick]) => make("button", { type: "button", onclick }, label))));
  }

  /** Says what the server refused. That it is away is said by itself. */
  refused(/** @type {any} */ error) {
    if (!(error instanceof Gone)) this.say("refused", error);
  }
}
