// The tabs of the panel: one is open at a time. Two more choices belong to Choose: what the points in view measure, and the
// gallery of profiles, which lies over the plane.

import { byId } from "./dom.js";

const TABS = ["start", "choose", "take"];
/** The tab that shows what the address names. */
const tabOf = (name) => (TABS.includes(name) ? name : "choose");

export class Tabs {
  /** `fold(isFolded)` folds the panel; `opened(tab)` hears which tab is open. */
  constructor(session, fold, opened) {
    this.session = session;
    this.opened = opened;
    const buttons = TABS.map((name) => byId(`tab-${name}`));
    const open = (name) => session.state.tab !== name && session.choose((state) => (state.tab = name), "tab");
    buttons.forEach((button, i) => {
      button.addEventListener("click", () => {
        fold(false);
        open(TABS[i]);
      });
      button.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = buttons[(i + step + buttons.length) % buttons.length];
        next.focus();
        next.click();
      });
    });
    const measures = /** @type {HTMLDetailsElement} */ (byId("understand"));
    measures.addEventListener("toggle", () => {
      const { tab } = session.state;
      if (measures.open && tab === "choose") open("understand");
      else if (!measures.open && tab === "understand") open("choose");
    });
    this.show();
  }

  /** Shows the tab that is chosen. */
  show() {
    const { tab } = this.session.state;
    const had = byId("panel-body").contains(document.activeElement);
    const root = document.documentElement;
    for (const name of TABS) {
      const isOpen = name === tabOf(tab);
      byId(`tab-${name}`).setAttribute("aria-selected", String(isOpen));
      byId(`tab-${name}`).tabIndex = isOpen ? 0 : -1;
      byId(name).hidden = !isOpen;
    }
    if (tabOf(root.dataset.tab) !== tabOf(tab)) byId("panel-body").scrollTop = 0;
    root.dataset.tab = tab;
    const measures = /** @type {HTMLDetailsElement} */ (byId("understand"));
    measures.open = tab === "understand";
    if (measures.open) measures.scrollIntoView();
    byId("gallery").hidden = tab !== "gallery";
    // Nothing that is covered can have the focus.
    for (const part of /** @type {HTMLCollectionOf<HTMLElement>} */ (byId("stage").children)) {
      if (part.role !== "alert" && part.role !== "status") part.inert = tab === "gallery" && part.id !== tab;
    }
    // What had the focus may be hidden now.
    if (had && !document.activeElement?.checkVisibility()) byId(tabOf(tab)).focus({ preventScroll: true });
    this.opened(tab);
  }
}
