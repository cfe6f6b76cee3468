// The tab Choose: layers, and for the one that is picked everything that makes its points. Its fields are made
// once; a choice sets their values, so the panel keeps its focus and scroll position.

import { byId, icon, make, settled, spoken } from "./dom.js";
import { faultsBefore } from "./faults.js";
import { check, fault, field, select, setOptions } from "./form.js";
import { isSent } from "./sent.js";
import { MAP_WORDS, PROFILE_WORDS, choicesOf, including, nice, profileNames } from "./profiles.js";
import { COLOR_NAMES, LAYER, MOST_LAYERS } from "./state.js";
import { Kinds } from "./kinds.js";

const AMOUNT_WORDS = { spacing: "Spacing", density: "Density", min_distance: "Minimum distance" };
const WARP_WORDS = { "": "Set by the seed", off: "Off", on: "On", 0.5: "Half as strong", 1.5: "Stronger", 2: "Strongest" };
const SETTLE_WORDS = { "": "Default", 0: "Off", 1: "One step", 2: "Two steps", 3: "Three steps", 4: "Four steps" };
const DIE = "M5 3h14a2 2 0 0 1 2 2v14a2 2 0 0 1-2 2H5a2 2 0 0 1-2-2V5a2 2 0 0 1 2-2zM8.5 8.5h.01M15.5 8.5h.01M12 12h.01M8.5 15.5h.01M15.5 15.5h.01";
/** The slider of the amount reaches this many doublings to each side. */
const DOUBLINGS = 3;
/** The fields that can be wrong. */
const FIELDS = ["profile", "alpha", "map", "amount", "seed", "warp", "settle", "field", "range", "variants", "spread", "clear"];
/** A number for a seed, as the die throws it. */
const thrown = () => String(1 + Math.floor(Math.random() * 999_999));

export class Controls {
  /** @type {HTMLElement} */
  bar;
  /** @type {HTMLElement} */
  shade;
  /** @type {HTMLElement} */
  range;
  /** @type {HTMLElement} */
  clear;
  /** @type {HTMLElement} */
  remove;
  /** @type {HTMLElement} */
  own;
  /** @type {HTMLElement} */
  worldField;
  /** @type {HTMLElement} */
  worldOwn;
  /** @type {HTMLElement} */
  worldLayers;
  /** @type {HTMLElement} */
  variant;
  /** @type {Kinds} */
  kinds;

  /** The server's lists: its tables (`profiles`), its fields, the names of its worlds; `stipple` takes a picture's file. */
  constructor(session, { profiles, fields, worlds }, stipple) {
    this.session = session;
    this.profiles = profiles;
    this.fields = fields.map(({ name }) => name);
    this.worlds = worlds;
    this.stipple = stipple;
    this.picked = 0;
    this.notes = [];
    this.root = byId("fields");
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

  build() {
    this.bar = make("div", { class: "layers", role: "group", "aria-label": "Layers" });
    this.kinds = new Kinds(this.profiles, (members) => this.change(members), this.text("variants"));
    this.own = make("div", { class: "fields" },
      this.bar, ...this.kind(), ...this.amount(), this.where(), this.kinds.element, this.expert(), this.shown(), this.looks());
    this.root.replaceChildren(this.world(), this.own, this.ofWorld());
  }

  /** The choice of a world of the server. */
  world() {
    const choose = (world) => this.session.choose((state) => Object.assign(state, { world, worldSeed: "" }), "layers");
    this.worldField = field("World", "world", select("world", choose));
    return this.worldField;
  }

  /** A world: its seed and what its layers are, which the server says. */
  ofWorld() {
    const choose = (worldSeed) => this.session.choose((state) => (state.worldSeed = worldSeed), "layers");
    const seed = make("input", {
      type: "text", id: "world-seed", inputmode: "numeric", placeholder: "the world's own", autocomplete: "off",
      onchange: (event) => /^\d{0,20}$/.test(event.target.value.trim()) && choose(event.target.value.trim()),
    });
    const again = make("button", { type: "button", title: "Another seed", onclick: () => choose(thrown()) }, icon(DIE, "Another seed"));
    this.worldLayers = make("p", { class: "note legend", id: "world-layers" });
    this.worldOwn = make("div", { class: "fields", id: "of-world" },
      make("p", { class: "note" }, "A world is described once, on the server, and requested by its name: layers with their distances, fields and seeds."),
      this.worldLayers, field("Seed", "world-seed", make("div", { class: "joined" }, seed, again)));
    return this.worldOwn;
  }

  updateWorld() {
    const { world, worldSeed, layers } = this.session.state;
    setOptions(byId("world"), [["", "Layers of your own"], ...(world ? including(this.worlds, world) : this.worlds)], world);
    this.worldField.hidden = this.worlds.length === 0 && !world;
    this.own.hidden = Boolean(world);
    this.worldOwn.hidden = !world;
    byId("paint-open").disabled = Boolean(world);
    const seed = /** @type {HTMLInputElement} */ (byId("world-seed"));
    if (document.activeElement !== seed) seed.value = worldSeed ?? "";
    this.worldLayers.replaceChildren(...(layers[0].world ? layers : [])
      .map(({ name, color }) => make("span", {}, make("i", { class: `swatch-${color}` }), name)));
  }

  kind() {
    return [field("Profile", "profile", select("profile", (profile) => this.change({ profile, alpha: "", map: "" }), { "aria-describedby": "about-profile" }),
      make("p", { class: "note", id: "about-profile" }),
      make("button", { type: "button", id: "open-gallery", onclick: () => this.openGallery() }, "Compare all profiles"))];
  }

  openGallery() {
    this.session.choose((state) => (state.tab = "gallery"), "tab");
    byId("gallery").focus({ preventScroll: true });
  }

  amount() {
    const by = select("by", (to) => this.change({ by: to, amount: this.converted(to) }), { "aria-label": "Amount by" });
    const slide = (event) => {
      const { layer } = this;
      this.holds = true;
      this.hold({ amount: String(Number((2 ** Number(event.target.value)).toPrecision(3))) });
      /** @type {HTMLInputElement} */ (byId("amount")).value = layer.amount;
    };
    const slider = make("input", {
      type: "range", id: "amount-slider", step: "any", "aria-label": "Amount", oninput: slide,
      onchange: () => {
        this.holds = false;
        this.session.release();
        this.update();
      },
    });
    const again = make("button", {
      type: "button", id: "another-seed", title: "Another seed",
      onclick: () => this.change({ seed: thrown() }),
    }, icon(DIE, "Another seed"));
    return [
      field("How many", "amount",
        make("div", { class: "joined" }, by, this.text("amount", { inputmode: "decimal", "aria-describedby": "about-amount" })),
        slider, make("p", { class: "note", id: "about-amount" })),
      field("Seed", "seed", make("div", { class: "joined" }, this.text("seed", { inputmode: "numeric" }), again)),
    ];
  }

  /** The controls that experts need: few readers change them. */
  expert() {
    const { layer } = this;
    const standard = () => choicesOf(this.profiles, this.layer);
    const isOpen = Boolean(layer.alpha || layer.map || layer.warp || layer.settle);
    return make("details", { class: "group", id: "expert", open: isOpen }, make("summary", {}, "Pattern, warp and settling"),
      make("div", { class: "pair" },
        field("Pattern α", "alpha", select("alpha", (value) => this.change({ alpha: value === standard().standard ? "" : value, map: "" }))),
        field("Map size", "map", select("map", (map) => this.change({ map: map === standard().maps[0] ? "" : map })))),
      field("Warp", "warp", select("warp", (warp) => this.change({ warp })),
        make("p", { class: "note" }, "The warp bends the pattern a little, so that no direction is special.")),
      field("Settling", "settle", select("settle", (settle) => this.change({ settle })),
        make("p", { class: "note" }, "In a field, points take small steps, two by default, until they lie evenly. Without a field, one step moves the closest pairs apart.")));
  }

  /** The amount in other terms, as the server has said it. */
  converted(to) {
    const understood = this.notes[this.picked]?.understood;
    const value = understood?.[{ spacing: "spacing", density: "density", min_distance: "least_distance" }[to]];
    return value ? String(Number(value.toPrecision(6))) : this.layer.amount;
  }

  /** Where the points are: everywhere, in a field, or as a picture is dark. */
  where() {
    const file = make("input", {
      type: "file", id: "picture", accept: "image/*", hidden: true,
      onchange: (event) => event.target.files[0] && this.stipple(event.target.files[0]),
    });
    this.shade = check("shade-field", "Show it under the points", (shade) => this.change({ shade }));
    return make("div", { class: "group", role: "group", "aria-label": "Where" },
      field("Field", "field", select("field", (value) => this.change({ field: value, paint: "" }))),
      this.shade, file,
      make("button", { type: "button", id: "choose-picture", onclick: () => file.click() }, "Stipple a picture …"),
      make("p", { class: "note" }, "Or drop one on the plane: dots gather where it is dark."));
  }

  shown() {
    const box = (member, words) => check(member, words, (is) => this.change({ [member]: is }));
    this.range = field("Smallest and largest scale", "range", this.text("range"));
    this.clear = field("Distance to the layers above", "clear", this.text("clear", { inputmode: "decimal", placeholder: "0" }),
      make("p", { class: "note", id: "about-clear", role: "status" }));
    return make("div", { class: "group", role: "group", "aria-label": "Values of each point" },
      make("span", { class: "label" }, "Values of each point"),
      box("angle", "Angle, as arrows"), box("scale", "Scale, as sizes"), this.range,
      this.variant = box("variant", "Variant, as shapes"), this.clear);
  }

  looks() {
    const swatches = COLOR_NAMES.map((name, i) => make("label", { title: name },
      make("input", { type: "radio", name: "color", id: `color-${i}`, "aria-label": name, onchange: () => this.change({ color: i }) }),
      make("i", { class: `swatch-${i}` })));
    const size = make("input", {
      type: "range", id: "dot", min: "0.25", max: "4", step: "0.05", "aria-label": "Size of points",
      oninput: (event) => this.hold({ dot: Number(event.target.value) }),
      onchange: () => this.session.release(),
    });
    const remove = () => this.session.choose((state) => state.layers.splice(this.picked, 1), "layers");
    this.remove = make("button", { type: "button", id: "remove-layer", onclick: remove }, "Remove this layer");
    return make("div", { class: "group", role: "group", "aria-label": "Looks" },
      make("span", { class: "label" }, "Color and size"),
      make("div", { class: "swatches", role: "radiogroup", "aria-label": "Color" }, swatches),
      size, this.remove);
  }

  text(member, attributes = {}) {
    const typed = (event) => {
      const { picked } = this;
      const { value } = event.target;
      this.typing = member;
      this.type((state) => Object.assign(state.layers[picked], { [member]: value }));
    };
    return make("input", {
      type: "text", id: member, spellcheck: "false", autocomplete: "off", ...attributes, oninput: typed,
      onchange: (event) => event.target.value === this.layer[member] || this.change({ [member]: event.target.value }),
    });
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
    if (this.bar.childElementCount !== layers.length + (layers.length < MOST_LAYERS ? 1 : 0)) {
      const focused = this.bar.contains(document.activeElement) ? document.activeElement?.id : null;
      const buttons = layers.map((_, i) => make("button", {
        type: "button", id: `layer-${i}`, onclick: () => this.pick(i),
      }, make("i"), make("span")));
      const add = make("button", { type: "button", id: "add-layer", onclick: () => this.addLayer() }, "+ Add a layer");
      this.bar.replaceChildren(...buttons, ...(layers.length < MOST_LAYERS ? [add] : []));
      if (focused) (byId(focused) ?? add).focus();
    }
    layers.forEach((layer, i) => {
      const button = this.bar.children[i];
      button.setAttribute("aria-pressed", String(i === this.picked));
      const [swatch, name] = button.children;
      swatch.className = `swatch-${layer.color}`;
      name.textContent = `${i + 1} ${layer.profile}${layer.lod ? `, 1 in ${Math.round(1 / Number(layer.lod))}` : ""}`;
    });
  }

  /** Sets every field to what is chosen, but for one that is being typed in. */
  update() {
    this.picked = Math.min(this.picked, this.session.state.layers.length - 1);
    const { layer, picked, root } = this;
    this.updateWorld();
    if (layer.world) return;
    this.updateBar();
    /** @type {(id: string) => any} */
    const set = (id) => root.querySelector(`#${id}`);
    const { alphas, alpha, maps, map } = choicesOf(this.profiles, layer);
    setOptions(set("profile"), including(profileNames(this.profiles), layer.profile), layer.profile);
    setOptions(set("alpha"), alphas.map((a) => [a, nice(a)]), alpha);
    setOptions(set("map"), maps.map((m) => [m, MAP_WORDS[m] ?? m]), map);
    setOptions(set("by"), Object.entries(AMOUNT_WORDS), layer.by);
    const warps = including(Object.keys(WARP_WORDS), layer.warp).map((w) => [w, WARP_WORDS[w] ?? w]);
    setOptions(set("warp"), warps.sort((a, b) => warpOrder(a[0]) - warpOrder(b[0])), layer.warp);
    const steps = including(Object.keys(SETTLE_WORDS), layer.settle).map((k) => [k, SETTLE_WORDS[k] ?? k]);
    setOptions(set("settle"), steps.sort((a, b) => (a[0] || -1) - (b[0] || -1)), layer.settle);
    setOptions(set("field"), this.fieldChoices(), layer.field);
    for (const member of ["amount", "seed", "range", "variants", "clear"]) {
      const input = set(member);
      if (this.typing !== member && input.value !== layer[member]) input.value = layer[member];
    }
    this.updateSlider(set("amount-slider"));
    for (const member of ["angle", "scale", "variant"]) set(member).checked = layer[member];
    set("shade-field").checked = layer.shade;
    set(`color-${layer.color}`).checked = true;
    if (set("dot").value !== String(layer.dot)) set("dot").value = String(layer.dot);
    this.shade.hidden = !layer.field;
    this.range.hidden = !layer.scale;
    this.variant.hidden = Boolean(layer.spread);
    this.clear.hidden = picked === 0;
    this.remove.hidden = this.session.state.layers.length < 2;
    this.kinds.update(layer, this.session.state.layers, this.root);
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
    for (const id of FIELDS) fault(this.root, id, all[id]);
    if (all.alpha || all.map || all.warp || all.settle) /** @type {HTMLDetailsElement} */ (byId("expert")).open = true;
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
