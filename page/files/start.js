// The tab Start: links to views, with pictures that were made once (`just pictures`), and the argument for Strew, which is drawn
// when the plane is at rest.

import { Argument } from "./argument.js";
import { byId } from "./dom.js";
import { initial } from "./state.js";

export class Start {
  /** `opened()` is called when the plane alone is to be seen, `say(words)` with what a view is, once it was chosen. */
  constructor(session, opened, say) {
    this.session = session;
    this.argument = new Argument();
    this.isFilled = false;
    byId("view-plane").addEventListener("click", (event) => {
      event.preventDefault();
      session.choose((state) => Object.assign(state, { ...initial(), tab: "choose" }), "layers", "view", "tab");
      opened();
    });
    for (const view of document.querySelectorAll(".view")) {
      const [name, about] = ["b", "small"].map((tag) => view.querySelector(tag)?.textContent);
      view.addEventListener("click", () => say(`${name}. ${about}`));
    }
  }

  get isOpen() {
    return this.session.state.tab === "start";
  }

  rested() {
    if (!this.isOpen || this.isFilled) return;
    this.isFilled = true;
    this.argument.load().then(() => (document.documentElement.dataset.start = "ready"));
  }

  opened() {
    if (document.documentElement.dataset.state === "ready") this.rested();
    this.themed();
  }

  themed() {
    if (this.isOpen) this.argument.themed();
  }
}
