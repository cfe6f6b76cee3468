// The tab Choose: layers, and for the one that is picked everything that makes its points. Its fields are in the markup;
// a choice sets their values, so the panel keeps its focus and scroll position.

import { byId, icon, make, settled, spoken } from "./dom.js";
import { faultsBefore } from "./faults.js";
import { fault, setOptions, wrongAt } from "./form.js";
import { isSent } from "./sent.js";
import { MAP_WORDS, PROFILE_WORDS, choicesOf, including, nice, profileNames } from "./profiles.js";
import { COLOR_NAMES, LAYER, MOST_LAYERS } from "./state.js";
import { SHAPES, SHAPE_SIGNS, isColored, kindColors } from "./marks.js";
import { allVariants, variantNames } from "./query.js";

const AMOUNT_WORDS = { spacing: "Spacing", density: "Density", min_distance: "Minimum distance" };
const WARP_WORDS = { "": "Set by the seed", off: "Off", on: "On", 0.5: "Half as strong", 1.5: "Stronger", 2: "Strongest" };
const SETTLE_WORDS = { "": "Default", 0: "Off", 1: "One step", 2: "Two steps", 3: "Three steps", 4: "Four steps" };
const DIE = "M5 3h14a2 2 0 0 1 2 2v14a2 2 0 0 1-2 2H5a2 2 0 0 1-2-2V5a2 2 0 0 1 2-2zM8.5 8.5h.01M15.5 8.5h.01M12 12h.01M8.5 15.5h.01M15.5 15.5h.01";
/** The slider of the amount reaches this many doublings to each side. */
const DOUBLINGS = 3;
/** The fields that can be wrong; the texts among them. */
const FIELDS = ["profile", "alpha", "map", "amount", "seed", "warp", "settle", "field", "range", "variants", "spread", "clear"];
const TEXTS = ["amount", "seed", "range", "variants", "clear"];
/** The input of an id. */
const inputAt = (id) => /** @type {HTMLInputElement} */ (byId(id));
/** The element that is shown or hidden with a control: it, its label and its words. */
const lineOf = (id) => /** @type {HTMLElement} */ (byId(id).closest(".field, .check"));

/** Calls a function with a control when something happens to it. */
function listen(id, event, call) {
  byId(id).addEventListener(event, () => call(inputAt(id)));
}

/** A number for a seed, as the die throws it. */
const thrown = () => String(1 + Math.floor(Math.random() * 999_999));

export class Controls {
  /** The server's lists: its tables (`profiles`), its fields, its worlds; `stipple` takes a picture's file. */
  constructor(session, { profiles, fields, worlds }, stipple) {
    this.session = session;
    this.profiles = profiles;
    this.fields = fields.map(({ name }) => name);
    this.worlds = worlds.map(({ name }) => name);
    this.stipple = stipple;
    this.picked = 0;
    this.notes = [];
    this.typing = null;
    this.type = settled(350, (change) => {
      this.typing = null;
      session.choose(change, "layers");
    });
    session.on((changed) => {
      if (!changed.has("layers")) return;
      // Where the view was restored too, what was being typed is gone with the rest.
      if (changed.has("view")) this.stopTyping();
      this.update();
    });
    this.kinds = new Kinds(profiles);
    this.build();
    this.update();
  }

  get layer() {
    return this.session.state.layers[this.picked];
  }

  stopTyping() {
    this.typing = null;
    this.type.cancel();
  }

  change(members) {
    const { picked } = this;
    this.stopTyping();
    this.session.choose((state) => Object.assign(state.layers[picked], members), "layers");
  }

  /** A change while a slider moves. */
  hold(members) {
    const { picked } = this;
    this.stopTyping();
    this.session.hold((state) => Object.assign(state.layers[picked], members), "layers");
  }

  /** Has the fields, which the markup has, change the layer. */
  build() {
    const { session } = this;
    for (const id of FIELDS) wrongAt(byId(id));
    const standard = () => choicesOf(this.profiles, this.layer);
    /** @type {Record<string, (value: string) => object>} */
    const lists = {
      profile: (profile) => ({ profile, alpha: "", map: "" }),
      by: (by) => ({ by, amount: this.converted(by) }),
      field: (field) => ({ field, paint: "" }),
      spread: (spread) => this.kinds.changed(spread),
      ratio: (ratio) => ({ variants: named(ratio) }),
      alpha: (alpha) => ({ alpha: alpha === standard().standard ? "" : alpha, map: "" }),
      map: (map) => ({ map: map === standard().maps[0] ? "" : map }),
      warp: (warp) => ({ warp }),
      settle: (settle) => ({ settle }),
    };
    for (const [id, members] of Object.entries(lists)) listen(id, "change", ({ value }) => this.change(members(value)));
    for (const member of TEXTS) this.text(member);
    for (const member of ["angle", "scale", "variant"]) listen(member, "change", ({ checked }) => this.change({ [member]: checked }));
    listen("shade-field", "change", ({ checked }) => this.change({ shade: checked }));
    listen("picture", "change", ({ files }) => files?.[0] && this.stipple(files[0]));
    listen("choose-picture", "click", () => byId("picture").click());
    listen("another-seed", "click", () => this.change({ seed: thrown() }));
    listen("dot", "input", ({ value }) => this.hold({ dot: Number(value) }));
    listen("dot", "change", () => session.release());
    listen("remove-layer", "click", () => session.choose((state) => state.layers.splice(this.picked, 1), "layers"));
    listen("open-gallery", "click", () => {
      session.choose((state) => (state.tab = "gallery"), "tab");
      byId("gallery").focus({ preventScroll: true });
    });
    for (const id of ["another-seed", "another-world-seed"]) byId(id).append(icon(DIE, "Another seed"));
    byId("swatches").append(...COLOR_NAMES.map((name, i) => make("label", { title: name },
      make("input", { type: "radio", name: "color", id: `color-${i}`, "aria-label": name, onchange: () => this.change({ color: i }) }),
      make("i", { class: `swatch-${i}` }))));
    const { layer } = this;
    byId("expert").open = Boolean(layer.alpha || layer.map || layer.warp || layer.settle);
    this.slider();
    this.world();
    byId("fields").hidden = false;
    // The fields that came moved it down.
    if (byId("understand").open) byId("understand").scrollIntoView();
  }

  /** The choice of a world of the server, and its seed. */
  world() {
    const choose = (members) => this.session.choose((state) => Object.assign(state, members), "layers");
    listen("world", "change", ({ value }) => choose({ world: value, worldSeed: "" }));
    listen("world-seed", "change", ({ value }) => /^\d{0,20}$/.test(value.trim()) && choose({ worldSeed: value.trim() }));
    listen("another-world-seed", "click", () => choose({ worldSeed: thrown() }));
  }

  updateWorld() {
    const { world, worldSeed, layers } = this.session.state;
    setOptions(byId("world"), [["", "Layers of your own"], ...(world ? including(this.worlds, world) : this.worlds)], world);
    byId("worlds").hidden = this.worlds.length === 0 && !world;
    byId("of-layers").hidden = Boolean(world);
    byId("of-world").hidden = !world;
    byId("paint-open").disabled = Boolean(world);
    const seed = byId("world-seed");
    if (document.activeElement !== seed) seed.value = worldSeed ?? "";
    byId("world-layers").replaceChildren(...(layers[0].world ? layers : [])
      .map(({ name, color }) => make("span", {}, make("i", { class: `swatch-${color}` }), name)));
  }

  /** The slider of the amount. */
  slider() {
    listen("amount-slider", "input", ({ value }) => {
      this.holds = true;
      this.hold({ amount: String(Number((2 ** Number(value)).toPrecision(3))) });
      byId("amount").value = this.layer.amount;
    });
    listen("amount-slider", "change", () => {
      this.holds = false;
      this.session.release();
      this.update();
    });
  }

  /** The amount in other terms, as the server has said it. */
  converted(to) {
    const understood = this.notes[this.picked]?.understood;
    const value = understood?.[{ spacing: "spacing", density: "density", min_distance: "least_distance" }[to]];
    return value ? String(Number(value.toPrecision(6))) : this.layer.amount;
  }

  /** Takes what is typed: after a while, or when the field is left. */
  text(member) {
    listen(member, "input", ({ value }) => {
      const { picked } = this;
      this.typing = member;
      this.type((state) => Object.assign(state.layers[picked], { [member]: value }));
    });
    listen(member, "change", ({ value }) => value === this.layer[member] || this.change({ [member]: value }));
  }

  /** Shows a layer's fields. */
  pick(i) {
    this.picked = i;
    this.stopTyping();
    this.update();
    this.session.tell("picked");
  }

  addLayer() {
    const { layers } = this.session.state;
    this.picked = layers.length;
    this.session.choose((state) => {
      const color = [...COLOR_NAMES.keys()].find((c) => !state.layers.some((layer) => layer.color === c)) ?? 0;
      const seed = String(state.layers.length + 1);
      state.layers.push({ ...LAYER, ...state.layers.at(-1), seed, color, angle: false, scale: false, variant: false, spread: "", lod: "" });
    }, "layers");
  }

  /** The layers as buttons: as many as there are, and one more to add. */
  updateBar() {
    const { layers } = this.session.state;
    const bar = byId("layers");
    if (bar.childElementCount !== layers.length + (layers.length < MOST_LAYERS ? 1 : 0)) {
      const focused = bar.contains(document.activeElement) ? document.activeElement?.id : null;
      const buttons = layers.map((_, i) => make("button", {
        type: "button", id: `layer-${i}`, onclick: () => this.pick(i),
      }, make("i"), make("span")));
      const add = make("button", { type: "button", id: "add-layer", onclick: () => this.addLayer() }, "+ Add a layer");
      bar.replaceChildren(...buttons, ...(layers.length < MOST_LAYERS ? [add] : []));
      if (focused) (byId(focused) ?? add).focus();
    }
    layers.forEach((layer, i) => {
      const button = bar.children[i];
      button.setAttribute("aria-pressed", String(i === this.picked));
      const [swatch, name] = button.children;
      swatch.className = `swatch-${layer.color}`;
      name.textContent = `${i + 1} ${layer.profile}${layer.lod ? `, 1 in ${Math.round(1 / Number(layer.lod))}` : ""}`;
    });
  }

  /** Sets every field to what is chosen, but for one that is being typed in. */
  update() {
    this.picked = Math.min(this.picked, this.session.state.layers.length - 1);
    const { layer, picked } = this;
    this.updateWorld();
    if (layer.world) return;
    this.updateBar();
    const { alphas, alpha, maps, map } = choicesOf(this.profiles, layer);
    const inWords = (words, value) => including(Object.keys(words), value).map((one) => [one, words[one] ?? one]);
    setOptions(byId("profile"), including(profileNames(this.profiles), layer.profile), layer.profile);
    setOptions(byId("alpha"), alphas.map((a) => [a, nice(a)]), alpha);
    setOptions(byId("map"), maps.map((m) => [m, MAP_WORDS[m] ?? m]), map);
    setOptions(byId("by"), Object.entries(AMOUNT_WORDS), layer.by);
    setOptions(byId("warp"), inWords(WARP_WORDS, layer.warp).sort((a, b) => warpOrder(a[0]) - warpOrder(b[0])), layer.warp);
    setOptions(byId("settle"), inWords(SETTLE_WORDS, layer.settle).sort((a, b) => (a[0] || -1) - (b[0] || -1)), layer.settle);
    setOptions(byId("field"), this.fieldChoices(), layer.field);
    for (const member of TEXTS) {
      const input = inputAt(member);
      if (this.typing !== member && input.value !== layer[member]) input.value = layer[member];
    }
    this.updateSlider(byId("amount-slider"));
    for (const member of ["angle", "scale", "variant"]) inputAt(member).checked = layer[member];
    byId("shade-field").checked = layer.shade;
    inputAt(`color-${layer.color}`).checked = true;
    if (byId("dot").value !== String(layer.dot)) byId("dot").value = String(layer.dot);
    lineOf("shade-field").hidden = !layer.field;
    lineOf("range").hidden = !layer.scale;
    lineOf("variant").hidden = Boolean(layer.spread);
    lineOf("clear").hidden = picked === 0;
    byId("remove-layer").hidden = this.session.state.layers.length < 2;
    this.kinds.update(layer, this.session.state.layers);
    this.tell();
  }

  fieldChoices() {
    const { layer } = this;
    const names = isSent(layer.field) || !layer.field ? this.fields : including(this.fields, layer.field);
    const choices = [["", "Everywhere"], ...names.map((name) => [name, name])];
    if (isSent(layer.field)) choices.push([layer.field, layer.paint ? "Painted by hand" : "A field that was sent"]);
    return choices;
  }

  /** The slider stays where it is held; otherwise the amount is its middle. */
  updateSlider(slider) {
    const amount = Number(this.layer.amount);
    slider.disabled = !(amount > 0 && Number.isFinite(amount));
    if (slider.disabled || this.holds) return;
    const middle = Math.log2(amount);
    Object.assign(slider, { min: String(middle - DOUBLINGS), max: String(middle + DOUBLINGS) });
    slider.value = String(middle);
    slider.setAttribute("aria-valuetext", `${AMOUNT_WORDS[this.layer.by]} ${this.layer.amount}`);
  }

  /** Takes what the server made of each layer: `{ understood }` or `{ faults }`. */
  note(notes) {
    this.notes = notes;
    this.update();
  }

  /** Takes how many points of each layer are in view. */
  counted(counts) {
    const isEmpty = this.picked > 0 && Number(this.layer.clear) > 0 && counts[this.picked] === 0;
    byId("about-clear").textContent = isEmpty ? "This distance leaves no room: no point of this layer is in view." : "";
  }

  tell() {
    if (this.layer.world) return;
    const { understood, faults } = this.notes[this.picked] ?? {};
    const all = { ...faults, ...faultsBefore(this.layer, this.picked) };
    for (const id of FIELDS) fault(byId("fields"), id, all[id]);
    if (all.alpha || all.map || all.warp || all.settle) byId("expert").open = true;
    byId("about-amount").textContent = understood && !faults ? said(understood) : "";
    byId("about-profile").textContent = PROFILE_WORDS[this.layer.profile] ?? "";
    byId("amount").setAttribute("aria-label", AMOUNT_WORDS[this.layer.by]);
  }
}

function said({ spacing, density, least_distance: least }) {
  const apart = least > 0 ? `any two at least ${spoken(least, 3)} apart` : "no minimum distance";
  return `Spacing ${spoken(spacing, 3)}, density ${spoken(density, 3)}, ${apart}.`;
}

function warpOrder(warp) {
  return warp === "" ? -2 : warp === "off" ? -1 : warp === "on" ? 1 : Number(warp);
}

/** How kinds are spread. */
const SPREAD_WORDS = {
  "": "Points of one kind",
  chance: "Kinds by chance",
  even: "Kinds, each evenly spread",
  joint: "Kinds, each as even as all together",
};
const ABOUT = {
  chance: "Each point has its kind by chance, so kinds clump.",
  even: "No point moves; which of them are of a kind is chosen evenly. The server prepares new shares once, which takes a while.",
  joint: "On a table made for these shares.",
};
/** The names of kinds until others are typed, and their shares. */
const NAMES = ["birch", "oak", "pine", "rowan", "bush", "fern"];
const SHARES = "birch:1,oak:3";

class Kinds {
  /** `profiles` are the server's tables. */
  constructor(profiles) {
    this.profiles = profiles;
  }

  /** The shares for which the server has a joint table of a layer's profile and pattern, with its map. */
  joint(layer) {
    const { alpha } = choicesOf(this.profiles, layer);
    const tables = this.profiles.filter((table) => table.profile === layer.profile && table.alpha === alpha && table.joint_kinds?.length > 0);
    return tables.find((table) => table.map === layer.map) ?? tables[0];
  }

  changed(spread) {
    const { layer } = this;
    const members = { spread };
    if (spread && layer.variants === LAYER.variants) members.variants = SHARES;
    if (spread === "joint") {
      const { joint_kinds: ratios, map } = this.joint(layer);
      const ratio = ratioOf(members.variants ?? layer.variants);
      if (!ratios.includes(ratio)) members.variants = named(ratios[0]);
      members.map = map;
    } else if (layer.spread === "joint") members.map = "";
    if (spread) members.variant = false;
    return members;
  }

  /** Shows a layer of those that there are. */
  update(layer, layers) {
    this.layer = layer;
    const ratios = this.joint(layer)?.joint_kinds ?? [];
    const offered = Object.keys(SPREAD_WORDS).filter((spread) => spread !== "joint" || ratios.length > 0 || layer.spread === "joint");
    setOptions(byId("spread"), offered.map((spread) => [spread, SPREAD_WORDS[spread]]), layer.spread);
    const ratio = ratioOf(layer.variants);
    const list = ratios.includes(ratio) ? ratios : [...ratios, ratio];
    setOptions(byId("ratio"), list, ratio);
    byId("about-spread").textContent = ABOUT[layer.spread] ?? "";
    const [shares, names] = ["ratio", "variants"].map((id) => /** @type {HTMLElement} */ (byId(id).parentElement));
    shares.hidden = layer.spread !== "joint";
    names.hidden = byId("legend").hidden = !layer.variant && !layer.spread;
    const signs = allVariants(layers);
    const colors = kindColors(layer);
    byId("legend").replaceChildren(...variantNames(layer).map((name, i) => (isColored(layer)
      ? make("span", {}, make("i", { class: `swatch-${colors[i % colors.length]}` }), name)
      : make("span", {}, `${SHAPE_SIGNS[signs.indexOf(name) % SHAPES.length] ?? "●"} ${name}`))));
  }
}

/** The ratio of shares, as the server writes it: in increasing order. */
function ratioOf(variants) {
  return variants.split(",").map((one) => Number(one.split(":")[1] ?? 1)).sort((a, b) => a - b).join(":");
}

/** Names for the shares of a ratio. */
function named(ratio) {
  return ratio.split(":").map((share, i) => `${NAMES[i % NAMES.length]}:${share}`).join(",");
}
