// The laboratory: the pattern of an α, its index torus and its set region side by side, and what
// follows from them. α and everything drawn is computed here; counts and displaced points are the server's.

import { Gone, askJson, wordsOf } from "../api.js";
import { byId, make, settled, spoken } from "../dom.js";
import { Part } from "../part.js";
import { Square, colors } from "./draw.js";
import { KNOWN, Pattern } from "./pattern.js";
import { MODES } from "./modes.js";
import { REACH } from "./settings.js";

/** The words of each choice of what is looked at. */
const WORDS = {
  index: "Index",
  arrangement: "Arrangement",
  clusters: "Clusters",
  map: "Map",
  displacement: "Displacement",
};

/** What each of them is about. */
const ABOUT = {
  index: "Each grid point has a place on a torus, its index. The points of the pattern are those whose index lies in a square, the set region.",
  arrangement: "An arrangement of points occurs if its image in index space fits the set region. What room is left, the margin, tells where and how often.",
  clusters: "Points near each other form a few shapes, and each shape has its own places in the set region.",
  map: "The index of a point decides all of its neighbors. Cut the set region into blocks: points of one block look alike as far as R.",
  displacement: "A table moves all points of a block by the same vector. That is all it takes to turn the pattern into blue noise.",
};

export class Works extends Part {
  /** @type {HTMLInputElement} */
  slider;
  /** @type {HTMLInputElement} */
  field;
  /** @type {HTMLButtonElement[]} */
  known;
  /** @type {HTMLButtonElement[]} */
  modes;
  /** @type {Square} */
  plane;
  /** @type {HTMLElement} */
  settings;
  /** @type {HTMLElement} */
  facts;
  /** @type {HTMLElement} */
  about;
  /** @type {HTMLElement} */
  caption;
  /** @type {Pattern | null} */
  last = null;

  constructor(session) {
    super();
    this.session = session;
    /** The value of a slider while it is held, before it is a choice. */
    this.live = {};
    this.pointed = null;
    this.build();
    session.on((changed) => {
      if (!changed.has("works")) return;
      this.live = {};
      this.show();
    });
    addEventListener("resize", settled(100, () => this.show()));
    this.ask = settled(300, () => this.fetch());
  }

  get isOpen() {
    return this.session.state.tab === "works";
  }

  /** The choices, with the values that are being dragged. */
  get chosen() {
    return { ...this.session.state.works, ...this.live };
  }

  choose(change) {
    this.live = {};
    this.session.choose((state) => (state.works = { ...state.works, ...change }), "works");
  }

  build() {
    this.slider = make("input", {
      type: "range", id: "works-slider", min: "1.01", max: "1.99", step: "0.0005", "aria-label": "α, as a slider",
      oninput: () => this.drag({ alpha: this.slider.value }),
      onchange: () => this.choose({ alpha: this.slider.value }),
    });
    this.field = make("input", {
      id: "works-alpha", spellcheck: "false", autocomplete: "off", enterkeyhint: "go",
      onchange: () => this.choose({ alpha: this.field.value.replace(/\s/g, "") }),
    });
    const known = KNOWN.map(([alpha, words]) => make("button", { type: "button", "data-alpha": alpha, onclick: () => this.choose({ alpha }) }, words));
    this.known = known;
    this.modes = Object.entries(WORDS).map(([mode, words]) => make("button", {
      type: "button", id: `works-${mode}`, onclick: () => this.choose({ mode }),
    }, words));
    const canvas = (id, label, attributes = {}) => make("canvas", { id, role: "img", "aria-label": label, ...attributes });
    this.plane = new Square(canvas("works-plane", "The pattern. Arrow keys choose a point, Enter adds it to an arrangement.", {
      tabindex: "0", role: "application", "aria-describedby": "works-facts",
      onkeydown: (event) => this.key(event),
      onpointermove: (event) => event.pointerType === "mouse" && this.hover(event),
      onpointerleave: () => this.leave(),
      onclick: (event) => this.tap(this.nearest(this.plane.at(event))),
    }));
    this.torus = new Square(canvas("works-torus", "The index torus, with the index of every grid point of the window."));
    this.region = new Square(canvas("works-region", "The set region, enlarged."));
    this.about = make("p", { id: "works-about" });
    this.caption = make("span", { class: "soft", id: "works-caption" });
    this.settings = make("div", { class: "settings" });
    this.facts = make("div", { class: "facts", id: "works-facts", role: "status", "aria-live": "polite" });
    const soft = (words) => make("span", { class: "soft" }, words);
    const figure = (square, name, caption) => make("figure", {}, square.canvas, make("figcaption", {}, make("b", {}, name), caption));
    byId("works").replaceChildren(make("div", {},
      make("h2", {}, "The laboratory"),
      make("p", {}, "Move α, choose points in the pattern, or use the arrow keys there. ", make("a", { href: "/how" }, "How it works, step by step"), " explains what is seen."),
      make("div", { class: "alpha" }, make("label", { class: "label", for: "works-alpha" }, "α, between 1 and 2"), this.slider, this.field,
        make("div", { class: "choices", role: "group", "aria-label": "Known α" }, known)),
      make("div", { class: "choices", role: "group", "aria-label": "What to look at" }, this.modes),
      this.about,
      make("div", { class: "drawings" },
        figure(this.plane, "The pattern", this.caption),
        make("div", { class: "side" },
          figure(this.torus, "The index torus", soft("(αx + y)/2 right, (αy + x)/2 up, without their whole parts")),
          figure(this.region, "The set region", soft("from 0 to t = (α − 1)/2 both ways"))),
        make("div", { class: "said" }, this.settings, this.facts)),
    ));
  }

  drag(change) {
    Object.assign(this.live, change);
    this.draw();
  }

  opened(tab) {
    if (tab === "works") this.show();
  }

  themed() {
    if (this.isOpen) this.draw();
  }

  /** The pattern of the chosen α, and its points; kept while α stays. */
  pattern() {
    const { alpha } = this.chosen;
    if (this.last?.text !== alpha) {
      const pattern = Pattern.of(alpha);
      if (!pattern) return null;
      this.last = pattern;
      this.points = pattern.points(REACH);
    }
    return this.last;
  }

  /** The point that is looked at: the hovered one, or the chosen one if it is a point of this pattern. */
  point() {
    if (this.pointed) return this.pointed;
    const [x, y] = this.chosen.point.split(":").map(Number);
    return this.last?.has(x, y) ? [x, y] : this.nearest([x, y]);
  }

  /** @param {number[]} place */
  nearest([x, y], among = this.points) {
    const far = ([a, b]) => (a - x) ** 2 + (b - y) ** 2;
    return among.reduce((best, point) => (far(point) < far(best) ? point : best), among[0] ?? [0, 0]);
  }

  hover(event) {
    const at = this.plane.at(event);
    const point = this.nearest(at);
    const isNear = Math.hypot(point[0] - at[0], point[1] - at[1]) < 1.5;
    const next = isNear ? point : null;
    if (String(next) === String(this.pointed)) return;
    this.pointed = next;
    this.draw();
  }

  leave() {
    this.pointed = null;
    this.draw();
  }

  tap(point) {
    if (!point || !this.pattern()) return;
    const mode = MODES[this.chosen.mode];
    this.choose(mode.tapped?.(this, point) ?? { point: point.join(":") });
  }

  /** Arrow keys go to the next point that way, Enter takes it. */
  key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      this.tap(this.point());
    }
    if (!step || !this.pattern()) return;
    event.preventDefault();
    const [x, y] = this.point();
    const along = ([a, b]) => (a - x) * step[0] + (b - y) * step[1];
    const aside = ([a, b]) => Math.abs((a - x) * step[1]) + Math.abs((b - y) * step[0]);
    const ahead = this.points.filter((p) => along(p) > 0 && aside(p) <= along(p));
    const cost = (p) => along(p) + 2 * aside(p);
    const next = ahead.sort((p, q) => cost(p) - cost(q))[0];
    if (!next) return;
    this.pointed = null;
    this.live.point = next.join(":");
    // A move is in the address, but no step of its own.
    this.session.state.works = { ...this.session.state.works, point: next.join(":") };
    this.session.write();
    this.draw();
  }

  /** Shows what is chosen: the settings of the mode, then the drawings. */
  show() {
    if (!this.isOpen) return;
    const { mode } = this.chosen;
    if (this.settings.dataset.mode !== mode) {
      this.settings.dataset.mode = mode;
      this.settings.replaceChildren(...(MODES[mode].settings?.(this) ?? []));
    }
    this.draw();
    this.ask();
  }

  draw() {
    const chosen = this.chosen;
    const pattern = this.pattern();
    if (document.activeElement !== this.field) this.field.value = chosen.alpha;
    this.field.setAttribute("aria-invalid", String(!pattern));
    for (const button of this.known) button.setAttribute("aria-pressed", String(button.dataset.alpha === chosen.alpha));
    for (const button of this.modes) button.setAttribute("aria-pressed", String(button.id === `works-${chosen.mode}`));
    const mode = MODES[chosen.mode];
    mode.follow?.(this, chosen);
    this.about.textContent = ABOUT[chosen.mode];
    this.caption.textContent = mode.caption?.(chosen) ?? "the grid points that belong to it";
    if (!pattern) {
      this.tell([`“${chosen.alpha}” is not an α: it must be a decimal or a fraction between 1 and 2, or one of the buttons.`]);
      return;
    }
    this.slider.value = String(pattern.alpha);
    this.slider.setAttribute("aria-valuetext", spoken(pattern.alpha, 6));
    const said = mode.draw(this, pattern, chosen, colors());
    this.tell(said);
    document.documentElement.dataset.works = `${chosen.mode} ${chosen.alpha}`;
  }

  tell(said) {
    this.facts.replaceChildren(...said.map((text) => (typeof text === "string" ? make("p", {}, text) : text)));
  }

  /** Requests the numbers of the shown mode that only the server knows. */
  async fetch() {
    const chosen = this.chosen;
    const pattern = this.isOpen && this.pattern();
    const mode = MODES[chosen.mode];
    const path = pattern && mode.path?.(this, pattern, chosen);
    if (!path || this.asked === path) return;
    this.asked = path;
    try {
      const answer = await askJson(path);
      if (this.asked === path) mode.answered(this, answer, path);
    } catch (error) {
      if (this.asked === path) mode.failed?.(this, error instanceof Gone ? "The server does not answer." : wordsOf(error));
      this.asked = null;
    }
    this.draw();
  }
}
