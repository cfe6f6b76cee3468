// What a page says above its picture: one box with the first of what there is to say.

import { Gone, Problem, hasKey, onPresence } from "./api.js";
import { byId, make } from "./dom.js";
import { keyForm } from "./form.js";

const AWAY = "The server does not answer. This page tries again by itself.";
/** What can be said, the most pressing first. */
const SUBJECTS = /** @type {const} */ (["away", "busy", "refused", "wrong", "blind"]);

export class Notice {
  /** @type {Partial<Record<typeof SUBJECTS[number], string | Error | null>>} */
  said = {};

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

  /** Says something of a subject; `null` takes it away. */
  say(/** @type {typeof SUBJECTS[number]} */ subject, /** @type {string | Error | null} */ words) {
    if ((this.said[subject] ?? null) === words) return;
    this.said[subject] = words;
    const { box } = this;
    const first = SUBJECTS.map((one) => this.said[one]).find(Boolean) ?? "";
    box.hidden = !first;
    if (!(first instanceof Error)) return box.replaceChildren(first);
    if (!(first instanceof Problem && first.isLocked)) {
      box.replaceChildren(first.message, " ", make("button", { type: "button", onclick: this.retry }, "Try again"));
    } else if (!byId("key")) box.replaceChildren(hasKey() ? first.message : "This server needs a key.", keyForm(this.retry));
  }

  /** Says what the server refused. That it is away is said by itself. */
  refused(/** @type {any} */ error) {
    if (!(error instanceof Gone)) this.say("refused", error);
  }
}
