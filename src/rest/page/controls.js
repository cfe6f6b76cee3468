// The tab Choose: layers, and for the one that is picked everything that makes its points.

import { byId, icon, make, settled, spoken } from "./dom.js";
import { isSent } from "./picture.js";
import { COLOR_NAMES, LAYER, MOST_LAYERS } from "./state.js";
import { SHAPES, SHAPE_SIGNS } from "./marks.js";
import { allVariants, variantNames } from "./query.js";

const AMOUNT_WORDS = { spacing: "Mean spacing", density: "Density", min_distance: "Least distance" };
const WARP_WORDS = { "": "As the seed asks", off: "Off", on: "On", 0.5: "Half as strong", 1.5: "Stronger", 2: "Strongest" };
const DIE = "M5 3h14a2 2 0 0 1 2 2v14a2 2 0 0 1-2 2H5a2 2 0 0 1-2-2V5a2 2 0 0 1 2-2zM8.5 8.5h.01M15.5 8.5h.01M12 12h.01M8.5 15.5h.01M15.5 15.5h.01";

export class Controls {
  /** `profiles` is the server's list of tables, `fields` that of fields; `stipple` takes a picture's file. */
  constructor(session, profiles, fields, stipple) {
    this.session = session;
    this.profiles = profiles;
    this.fields = fields.map(({ name }) => name);
    this.stipple = stipple;
    this.picked = 0;
    this.notes = [];
    this.root = byId("choose");
    this.type = settled(350, (change) => session.choose(change, "layers"));
    session.on((changed) => changed.has("layers") && this.render());
    this.render();
  }

  get layer() {
    return this.session.state.layers[this.picked];
  }

  change(members, isTyped) {
    const { picked } = this;
    const change = (state) => Object.assign(state.layers[picked], members);
    if (isTyped) this.type(change);
    else {
      this.type.cancel();
      this.session.choose(change, "layers");
    }
  }

  /** Draws all of it anew; the focus stays where it was. */
  render() {
    this.picked = Math.min(this.picked, this.session.state.layers.length - 1);
    const focused = document.activeElement?.id;
    const selection = [document.activeElement?.selectionStart, document.activeElement?.selectionEnd];
    const typed = this.root.contains(document.activeElement) ? document.activeElement.value : null;
    this.root.replaceChildren(this.layerBar(), ...this.kind(), ...this.amount(), this.where(), this.shown(), this.looks());
    this.tell();
    const again = focused && this.root.querySelector(`#${CSS.escape(focused)}`);
    if (!again) return;
    again.focus();
    if (typed !== null && again.type === "text") {
      again.value = typed;
      again.setSelectionRange(...selection);
    }
  }

  layerBar() {
    const { layers } = this.session.state;
    const bar = layers.map((layer, i) => make("button", {
      type: "button",
      id: `layer-${i}`,
      "aria-pressed": String(i === this.picked),
      onclick: () => {
        this.picked = i;
        this.render();
      },
    }, make("i", { class: `swatch-${layer.color}` }), `${i + 1} ${layer.profile}`));
    const add = make("button", {
      type: "button",
      id: "add-layer",
      onclick: () => {
        this.picked = layers.length;
        this.session.choose((state) => {
          const color = [...COLOR_NAMES.keys()].find((c) => !state.layers.some((layer) => layer.color === c)) ?? 0;
          const seed = String(state.layers.length + 1);
          state.layers.push({ ...LAYER, ...state.layers.at(-1), seed, color, angle: false, scale: false, variant: false });
        }, "layers");
      },
    }, "+ Add a layer");
    return make("div", { class: "layers", role: "group", "aria-label": "Layers" }, bar, layers.length < MOST_LAYERS && add);
  }

  kind() {
    const { layer } = this;
    const names = [...new Set(this.profiles.map((table) => table.profile))];
    const alphas = [...new Set(this.tables().map((table) => table.alpha))];
    const alpha = layer.alpha || this.standardAlpha(alphas);
    const maps = this.tables().filter((table) => table.alpha === alpha).map((table) => table.map);
    const order = maps.sort((a, b) => "sml".indexOf(a) - "sml".indexOf(b));
    return [
      field("Profile", "profile", select("profile", including(names, layer.profile), layer.profile, (profile) => this.change({ profile, alpha: "", map: "" })),
        make("p", { class: "note", id: "about-profile" })),
      make("div", { class: "pair" },
        field("Pattern α", "alpha", select("alpha", including(alphas, alpha).map((a) => [a, nice(a)]), alpha,
          (value) => this.change({ alpha: value === this.standardAlpha(alphas) ? "" : value, map: "" }))),
        field("Map size", "map", select("map", including(order, layer.map || order[0]).map((m) => [m, MAP_WORDS[m] ?? m]), layer.map || order[0],
          (map) => this.change({ map: map === order[0] ? "" : map })))),
    ];
  }

  tables() {
    return this.profiles.filter((table) => table.profile === this.layer.profile);
  }

  standardAlpha(alphas) {
    return alphas.includes("(5-sqrt(3))/2") ? "(5-sqrt(3))/2" : alphas[0];
  }

  amount() {
    const { layer } = this;
    const by = select("by", Object.entries(AMOUNT_WORDS), layer.by, (to) => this.change({ by: to, amount: this.converted(to) }));
    by.setAttribute("aria-label", "Amount by");
    const value = this.text("amount", { inputmode: "decimal", "aria-describedby": "about-amount", "aria-label": AMOUNT_WORDS[layer.by] });
    const again = make("button", {
      type: "button", id: "another-seed", title: "Another seed",
      onclick: () => this.change({ seed: String(1 + Math.floor(Math.random() * 999_999)) }),
    }, icon(DIE, "Another seed"));
    const warps = including(Object.keys(WARP_WORDS), layer.warp).map((w) => [w, WARP_WORDS[w] ?? w]).sort((a, b) => warpOrder(a[0]) - warpOrder(b[0]));
    return [
      make("div", { class: "field" }, make("span", { class: "label" }, "How many"), make("div", { class: "joined" }, by, value),
        make("p", { class: "note", id: "about-amount" }), make("p", { class: "note bad", id: "wrong", role: "alert", hidden: true })),
      make("div", { class: "pair" },
        field("Seed", "seed", make("div", { class: "joined" }, this.text("seed", { inputmode: "numeric" }), again)),
        field("Warp", "warp", select("warp", warps, layer.warp, (warp) => this.change({ warp })))),
    ];
  }

  /** The amount in other terms, as the server has said it. */
  converted(to) {
    const understood = this.notes[this.picked]?.understood;
    const value = understood?.[{ spacing: "spacing", density: "density", min_distance: "least_distance" }[to]];
    return value ? String(Number(value.toPrecision(6))) : this.layer.amount;
  }

  /** Where the points are: everywhere, in a field, or as a picture is dark. */
  where() {
    const { layer } = this;
    const names = isSent(layer.field) || !layer.field ? this.fields : including(this.fields, layer.field);
    const choices = [["", "Everywhere"], ...names.map((name) => [name, name])];
    if (isSent(layer.field)) choices.push([layer.field, "A picture that was sent"]);
    const file = make("input", {
      type: "file", id: "picture", accept: "image/*", hidden: true,
      onchange: (event) => event.target.files[0] && this.stipple(event.target.files[0]),
    });
    const shade = make("input", {
      type: "checkbox", id: "shade-field", checked: layer.shade,
      onchange: (event) => this.change({ shade: event.target.checked }),
    });
    return make("div", { class: "group", role: "group", "aria-label": "Where" },
      field("Field", "field", select("field", choices, layer.field, (value) => this.change({ field: value }))),
      layer.field && make("label", { class: "check" }, shade, "Show it under the points"),
      file,
      make("button", { type: "button", id: "choose-picture", onclick: () => file.click() }, "Stipple a picture …"),
      make("p", { class: "note" }, "Or drop one on the plane: dots lie where it is dark."));
  }

  shown() {
    const { layer, picked } = this;
    const check = (member, words) => make("label", { class: "check" },
      make("input", {
        type: "checkbox", id: member, checked: layer[member],
        onchange: (event) => this.change({ [member]: event.target.checked }),
      }), words);
    const signs = allVariants(this.session.state.layers);
    const legend = variantNames(layer).map((name) => `${SHAPE_SIGNS[signs.indexOf(name) % SHAPES.length] ?? "●"} ${name}`).join("  ");
    return make("div", { class: "group", role: "group", "aria-label": "Values of each point" },
      make("span", { class: "label" }, "Values of each point"),
      check("angle", "Angle, as arrows"),
      check("scale", "Scale, as sizes"),
      layer.scale && this.text("range", { "aria-label": "Least and greatest scale" }),
      check("variant", "Variant, as shapes"),
      layer.variant && this.text("variants", { "aria-label": "Names of variants with their weights" }),
      layer.variant && make("p", { class: "note" }, legend),
      picked > 0 && field("Keeps clear of the layers before by", "clear", this.text("clear", { inputmode: "decimal", placeholder: "0" })));
  }

  looks() {
    const { layer, picked } = this;
    const swatches = COLOR_NAMES.map((name, i) => make("label", { title: name },
      make("input", { type: "radio", name: "color", id: `color-${i}`, checked: i === layer.color, "aria-label": name, onchange: () => this.change({ color: i }) }),
      make("i", { class: `swatch-${i}` })));
    const size = make("input", {
      type: "range", id: "dot", min: "0.25", max: "4", step: "0.05", value: String(layer.dot), "aria-label": "Size of points",
      onchange: (event) => this.change({ dot: Number(event.target.value) }),
    });
    const remove = () => this.session.choose((state) => state.layers.splice(picked, 1), "layers");
    return make("div", { class: "group", role: "group", "aria-label": "Looks" },
      make("span", { class: "label" }, "Color and size"),
      make("div", { class: "swatches", role: "radiogroup", "aria-label": "Color" }, swatches),
      size,
      this.session.state.layers.length > 1 && make("button", { type: "button", id: "remove-layer", onclick: remove }, "Remove this layer"));
  }

  text(member, attributes = {}) {
    return make("input", {
      type: "text", id: member, value: this.layer[member], spellcheck: "false", autocomplete: "off", ...attributes,
      oninput: (event) => this.change({ [member]: event.target.value }, true),
      onchange: (event) => event.target.value === this.layer[member] || this.change({ [member]: event.target.value }),
    });
  }

  /** Takes what the server made of each layer: `{ understood }` or `{ error }`. */
  note(notes) {
    this.notes = notes;
    this.tell();
  }

  tell() {
    const { understood, error } = this.notes[this.picked] ?? {};
    const wrong = byId("wrong");
    wrong.hidden = !error;
    wrong.textContent = error ?? "";
    byId("amount").setAttribute("aria-invalid", String(Boolean(error && /spacing|density|min_distance/.test(error))));
    byId("seed").setAttribute("aria-invalid", String(Boolean(error && /`seed`/.test(error))));
    byId("about-amount").textContent = understood && !error ? said(understood) : "";
    byId("about-profile").textContent = PROFILE_WORDS[this.layer.profile] ?? "";
  }
}

function said({ spacing, density, least_distance: least }) {
  const apart = least > 0 ? `any two at least ${spoken(least, 3)} apart` : "no least distance";
  return `Spacing ${spoken(spacing, 3)}, density ${spoken(density, 3)}, ${apart}.`;
}

const MAP_WORDS = { s: "s (small)", m: "m (medium)", l: "l (large)" };

/** What the built-in profiles are for. */
export const PROFILE_WORDS = {
  blue: "Even and without direction: the one to begin with.",
  sharp: "Even with sharper order, close to the best of its kind.",
  spaced: "Points keep as far apart as they can.",
  lloyd: "Centers of their own cells, almost a honeycomb.",
  step: "No low frequencies at all, the rest as random.",
  green: "Clusters of a certain size, evenly strewn.",
  pink: "Clouds of all sizes, as in nature.",
  "single-peak": "One frequency stands out.",
  pattern: "The bare pattern, not yet moved by a table.",
};

/** α as people write it. */
function nice(alpha) {
  return alpha.replace(/sqrt\((\d+)\)/g, "√$1");
}

function including(list, value) {
  return list.includes(value) ? list : [...list, value];
}

function warpOrder(warp) {
  return warp === "" ? -2 : warp === "off" ? -1 : warp === "on" ? 1 : Number(warp);
}

function field(words, id, control, ...more) {
  return make("div", { class: "field" }, make("label", { for: id }, words), control, ...more);
}

function select(id, options, value, changed) {
  const list = options.map((option) => {
    const [key, words] = Array.isArray(option) ? option : [option, option];
    return make("option", { value: key, selected: key === value }, words);
  });
  return make("select", { id, onchange: (event) => changed(event.target.value) }, list);
}
