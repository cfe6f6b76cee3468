// The tabs of the panel: one is open at a time, and some lie over the plane.

import { byId } from "./dom.js";

/** Tabs whose contents lie over the plane. */
const COVERS = ["gallery", "works"];
const TABS = ["start", "choose", "understand", "take", "gallery", "works"];

export class Tabs {
  /** `fold(isFolded)` folds the panel; `opened(tab)` hears which tab is open. */
  constructor(session, fold, opened) {
    this.session = session;
    this.opened = opened;
    const buttons = TABS.map((name) => byId(`tab-${name}`));
    buttons.forEach((button, i) => {
      button.addEventListener("click", () => {
        fold(false);
        if (session.state.tab !== TABS[i]) session.choose((state) => (state.tab = TABS[i]), "tab");
      });
      button.addEventListener("keydown", (event) => {
        // What lies over the plane comes before the tabs in the page, but after them for keys.
        if (event.key === "Tab" && !event.shiftKey && COVERS.includes(TABS[i])) {
          event.preventDefault();
          return byId(TABS[i]).focus({ preventScroll: true });
        }
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = buttons[(i + step + buttons.length) % buttons.length];
        next.focus();
        next.click();
      });
    });
    this.show();
  }

  /** Shows the tab that is chosen. */
  show() {
    const { tab } = this.session.state;
    const root = document.documentElement;
    for (const name of TABS) {
      const isOpen = name === tab;
      byId(`tab-${name}`).setAttribute("aria-selected", String(isOpen));
      byId(`tab-${name}`).tabIndex = isOpen ? 0 : -1;
      byId(name).hidden = !isOpen;
    }
    if (root.dataset.tab !== tab) byId("panel-body").scrollTop = 0;
    root.dataset.tab = tab;
    // Nothing that is covered can have the focus.
    for (const part of /** @type {HTMLCollectionOf<HTMLElement>} */ (byId("stage").children)) {
      if (part.role !== "alert" && part.role !== "status") part.inert = COVERS.includes(tab) && part.id !== tab;
    }
    byId("gallery-help").hidden = tab !== "gallery";
    byId("works-help").hidden = tab !== "works";
    this.opened(tab);
  }
}
