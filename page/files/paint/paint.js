// Fields by hand: a bar of tools on the plane, what was painted with them, and the field that it is.

import { Problem, wordsOf } from "../api.js";
import { byId, icon } from "../dom.js";
import { describe, documentOf, isSent, send } from "../sent.js";
import { MOST_PAINT } from "../state.js";
import { Brush } from "./brush.js";
import { blank, fieldOf, read, simplified, written } from "./strokes.js";

const TOOLS = ["paint", "road", "erase"];
/** A line is kept to this part of the brush's size. */
const FINENESS = 1 / 24;
const BRUSH = "M14 6l4 4M4 20c3 0 5-1 5-4a3 3 0 0 0-3-3c-2 0-2 2-2 3s0 3-2 4c1 0 1 0 2 0zM9 14l8.5-9.5a2 2 0 0 1 3 3L11 16";

/** The field below what is painted, described in full. */
const whole = (name) => documentOf(name) ?? { name };

/** The number of strokes. */
function strokes({ strokes: { length } }) {
  return `${length} ${length === 1 ? "stroke" : "strokes"}`;
}

export class Paint {
  /** `picked()` is the index of the layer that is painted on; `say(words)` shows what went wrong. */
  constructor(session, plane, { picked, say }) {
    this.session = session;
    this.plane = plane;
    this.picked = picked;
    this.fail = say;
    /** @type {string | null} */
    this.tool = null;
    this.width = 0.12;
    this.strength = 1;
    this.turn = 0;
    /** @type {any} */
    this.cleared = null;
    /**
     * What is painted on a layer, and that layer.
     * @type {any}
     */
    this.work = blank();
    /** @type {any} */
    this.owner = null;
    /** Texts of what was painted by the fields that they are, for those that the address does not hold. */
    this.texts = new Map();
    this.toggle = byId("paint-open");
    this.canvas = byId("brush");
    this.bar = byId("paint");
    this.elsewhere = byId("paint-ground");
    this.build();
    this.brush = new Brush(this.canvas, plane, {
      drawn: (line) => this.drawn(line),
      left: () => this.use(null),
      say: (words) => this.say(words),
    });
    session.on((changed) => (changed.has("layers") || changed.has("picked")) && this.read());
    this.read();
  }

  /** Has the bar of tools, which the markup has, do what it says. */
  build() {
    const clicks = { open: () => this.use(this.tool ? null : "paint"), undo: () => this.undo(), done: () => this.use(null), clear: () => this.clear() };
    for (const [id, call] of Object.entries(clicks)) byId(`paint-${id}`).addEventListener("click", call);
    for (const tool of TOOLS) byId(`paint-tool-${tool}`).addEventListener("click", () => this.use(tool));
    this.toggle.prepend(icon(BRUSH));
    byId("paint-size").addEventListener("input", () => {
      this.width = Math.max(0.004, Number(byId("paint-size").value) ** 2);
      this.fit();
    });
    byId("paint-strength").addEventListener("input", () => (this.strength = Math.max(0.05, Number(byId("paint-strength").value))));
    this.elsewhere.addEventListener("change", () => this.change({ ground: Number(this.elsewhere.value) }));
    addEventListener("keydown", (event) => {
      if (!this.tool) return;
      if (event.key === "z" && (event.ctrlKey || event.metaKey) && !/** @type {Element} */ (event.target).matches("input:not([type=range]), textarea")) {
        event.preventDefault();
        this.undo();
      } else if (event.key === "Escape" && event.target !== this.canvas) this.use(null);
    });
    this.render();
  }

  /** Takes a tool into the hand, or puts it down. */
  use(tool) {
    const had = this.tool;
    this.follow();
    this.tool = tool;
    this.brush.kind = tool ?? "paint";
    this.brush.line = null;
    this.render();
    this.fit();
    if (tool) {
      this.canvas.focus({ preventScroll: true });
      if (!had) this.say("Draw on the plane. Two fingers or the wheel move it, Escape leaves.");
    } else if (had) this.toggle.focus({ preventScroll: true });
  }

  render() {
    const { tool } = this;
    this.bar.hidden = this.canvas.hidden = !tool;
    this.toggle.setAttribute("aria-expanded", String(Boolean(tool)));
    for (const one of TOOLS) byId(`paint-tool-${one}`).setAttribute("aria-pressed", String(one === tool));
    byId("paint-strong").hidden = tool === "road";
    const { activeElement } = document;
    byId("paint-clear").disabled = this.work.strokes.length === 0;
    byId("paint-undo").disabled = this.work.strokes.length === 0 && !this.hasCleared;
    // A button that can do no more leaves the focus to what it worked on.
    if (tool && activeElement?.hasAttribute("disabled") && this.bar.contains(activeElement)) this.canvas.focus({ preventScroll: true });
    this.elsewhere.value = String(this.work.ground);
    /** @type {HTMLElement} */ (this.elsewhere.parentElement).hidden = Boolean(this.work.base);
  }

  /** The size of a brush in world units: a part of what is in view. */
  get brushSize() {
    return this.width * (this.plane.span || 1) * (this.tool === "road" ? 0.5 : 1);
  }

  fit() {
    this.brush.size = this.brushSize;
    if (this.tool) this.brush.draw();
  }

  moved() {
    if (this.tool) this.fit();
  }

  themed() {
    this.moved();
  }

  say(words) {
    byId("paint-said").textContent = words;
  }

  get layer() {
    const { layers } = this.session.state;
    return layers[Math.min(this.picked(), layers.length - 1)];
  }

  /** Takes what is painted on the layer that is picked, if that was another one before. */
  follow() {
    if (this.layer !== this.owner) this.read();
  }

  /** Takes what is painted from the layers, where it has changed. */
  read() {
    for (const layer of this.session.state.layers) if (layer.paint) this.known(layer);
    const { layer } = this;
    this.owner = layer;
    const text = layer.paint || this.texts.get(layer.field) || "";
    if (!text) this.work = blank(layer.field);
    else if (text !== written(this.work)) this.work = read(text);
    if (this.tool) this.say(this.work.strokes.length > 0 ? strokes(this.work) : "");
    this.render();
  }

  /** Sees that what a layer's text says is its field. */
  known(layer) {
    const text = this.texts.get(layer.field);
    if (text === layer.paint) return;
    const work = read(layer.paint);
    if (!layer.field) this.restore(layer, work);
    // A field that was chosen since is another one.
    else if (text !== undefined || !isSent(layer.field) || [...this.texts.values()].includes(layer.paint)) {
      this.session.correct(() => (layer.paint = ""));
    } else {
      this.texts.set(layer.field, layer.paint);
      describe(layer.field, fieldOf(work, whole));
    }
  }

  /** Sends what an address describes without the field's digest. */
  async restore(layer, work) {
    try {
      const field = await send(fieldOf(work), fieldOf(work, whole));
      this.texts.set(field, layer.paint);
      this.session.correct(() => (layer.field = field));
      this.session.tell("layers");
    } catch (error) {
      this.fail(wordsOf(error));
    }
  }

  drawn(line) {
    this.follow();
    const { tool, brushSize: size, strength, work } = this;
    const stroke = { kind: tool, size, strength: tool === "road" ? 1 : strength, line: simplified(line, size * FINENESS) };
    // A reader who begins with a brush wants to see its effect.
    const isFirst = work.strokes.length === 0 && !work.base && work.ground === 1 && tool === "paint";
    this.change({ strokes: [...work.strokes, stroke], ...(isFirst ? { ground: 0.1 } : {}) });
  }

  clear() {
    this.follow();
    const { layer, work } = this;
    this.change({ strokes: [] }, "Cleared");
    this.cleared = { layer, work };
    this.render();
  }

  /** Whether the last change took away all that was painted on this layer. */
  get hasCleared() {
    return this.cleared?.layer === this.layer && this.work.strokes.length === 0;
  }

  undo() {
    this.follow();
    if (this.hasCleared) {
      const { ground, strokes } = this.cleared.work;
      this.change({ ground, strokes }, "Restored");
    } else if (this.work.strokes.length > 0) this.change({ strokes: this.work.strokes.slice(0, -1) }, "Undone");
  }

  /** Sends what is painted after a change, and shows it. */
  async change(members, words = "") {
    this.follow();
    this.cleared = null;
    const before = this.work;
    this.work = read(written({ ...before, ...members }));
    if (this.work.strokes.length === 0) this.work = blank(before.base);
    this.render();
    this.turn += 1;
    const mine = this.turn;
    const { work, layer } = this;
    const text = written(work);
    try {
      const field = text ? await send(fieldOf(work), fieldOf(work, whole)) : work.base;
      if (mine !== this.turn) return;
      if (text) this.texts.set(field, text);
      const amount = layer.by === "min_distance" ? { by: "spacing", amount: await this.spacing(layer) } : {};
      this.session.choose(() => Object.assign(layer, { field, paint: text, ...amount }), "layers");
      const where = text.length > MOST_PAINT ? ", too many for the address: Take has them in the request" : "";
      this.say(`${words ? `${words}: ` : ""}${strokes(work)}${where}`);
    } catch (error) {
      if (mine !== this.turn) return;
      if (this.owner === layer) this.work = before;
      this.render();
      const isTooMuch = error instanceof Problem && error.status === 400;
      this.fail(isTooMuch ? "One painting holds no more. Strokes of the same tool, size and strength in a row count as one." : wordsOf(error));
    }
  }

  /** In a field no least distance is kept, so a layer that has one goes on with the spacing that it had. */
  async spacing(layer) {
    const { spacing } = await this.session.understand({ ...layer, field: "" });
    return String(Number(spacing.toPrecision(6)));
  }
}
