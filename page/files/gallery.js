// The gallery: every profile as points, spectrum and radial power, side by side; each opens in the
// view.

import { encoded } from "./address.js";
import { ask, wordsOf } from "./api.js";
import { lineChart, pointPicture, spectrumPicture } from "./charts.js";
import { byId, make, spoken } from "./dom.js";
import { measure } from "./worker.js";
import { PROFILE_WORDS, profileNames } from "./profiles.js";
import { LAYER } from "./state.js";
import { HEXAGONAL, figureOf, recordedOf } from "./understand.js";

/** The side of what is measured and of what is drawn of it, in mean spacings. */
const MEASURED = 64;
const DRAWN = 20;

export class Gallery {
  constructor(session, profiles) {
    this.session = session;
    this.names = profileNames(profiles);
    // The one to begin with first, the bare pattern last.
    const rank = (name) => ({ blue: -1, pattern: 1 })[name] ?? 0;
    this.names.sort((a, b) => rank(a) - rank(b));
    this.cards = null;
    byId("close-gallery").addEventListener("click", () => session.choose((state) => (state.tab = "choose"), "tab"));
  }

  opened(tab) {
    if (tab === "gallery") this.show();
  }

  themed() {
    for (const card of this.cards ?? []) card.draw?.();
  }

  async show() {
    if (this.cards) return;
    this.cards = this.names.map((name) => this.card(name));
    byId("profile-cards").append(...this.cards.map((card) => card.element));
    const isWhole = await Promise.all(this.cards.map((card) => this.fill(card)));
    document.documentElement.dataset.gallery = isWhole.every(Boolean) ? "ready" : "failed";
  }

  card(name) {
    const picture = (label) => make("canvas", { class: "square", role: "img", "aria-label": `${label} of ${name}` });
    const [points, spectrum] = [picture("Points"), picture("Spectrum")];
    const curve = make("canvas", { role: "img", "aria-label": `Radial power of ${name}` });
    const about = make("p", {}, PROFILE_WORDS[name] ?? "");
    const figures = make("small", { class: "soft number" });
    const open = () => this.session.choose((state) => {
      const before = state.world ? {} : state.layers[0];
      Object.assign(state, { world: "", worldSeed: "", layers: [{ ...LAYER, ...before, profile: name, alpha: "", map: "" }] });
      if (state.layers[0].by === "min_distance") Object.assign(state.layers[0], { by: "spacing", amount: "1" });
      state.tab = "choose";
    }, "layers", "tab");
    const element = make("article", {},
      make("header", {}, make("h3", {}, name), make("button", { type: "button", id: `open-${name}`, onclick: open }, "Open")),
      make("div", { class: "pictures" }, points, make("div", { class: "awaited", "data-words": "measuring …" }, spectrum)), curve, about, figures);
    return { name, element, points, spectrum, curve, about, figures };
  }

  async fill(card) {
    const { name, points, spectrum, curve, figures, about } = card;
    try {
      const set = `bbox=0,0,${MEASURED},${MEASURED}&spacing=1&seed=1&profile=${encoded(name)}&format=f32`;
      const [answer, recorded] = await Promise.all([ask(`/v1/points?${set}`), recordedOf({ profile: name })]);
      const packed = new Float32Array(await answer.arrayBuffer());
      const table = recorded.measured.radial.values.map(([nu, power]) => [nu, power]);
      figures.textContent = `least distance ${spoken((figureOf(recorded, "delta_min") ?? NaN) * HEXAGONAL, 3)} · low power ${spoken(figureOf(recorded, "low_power") ?? NaN, 3)}`;
      card.draw = () => {
        pointPicture(points, packed, DRAWN);
        if (card.measured) spectrumPicture(spectrum, card.measured.image, card.measured.cells);
        lineChart(curve, table, { aspect: 0.36 });
      };
      card.draw();
      card.measured = await measure(Float64Array.from(packed), MEASURED);
      spectrum.parentElement.classList.remove("awaited");
      card.draw();
      return true;
    } catch (error) {
      about.textContent = `Not shown: ${wordsOf(error)}`;
      about.className = "bad";
      spectrum.parentElement.classList.remove("awaited");
      return false;
    }
  }
}
