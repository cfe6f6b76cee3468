// The choices on the page, kept in step with the address and with the server's resolved values.

import { askJson } from "./api.js";
import { joined, setOf, togetherBody, worldIn } from "./query.js";
import { LAYER, fromHash, toHash } from "./state.js";
import { settled } from "./dom.js";
import { layersOfWorld } from "./worlds.js";

/** One choice at a time; `listeners` hear what has changed: `layers`, `picked`, `view`, `tab`, `works`. */
export class Session {
  constructor() {
    this.state = fromHash(location.hash);
    this.listeners = new Set();
    /** The server's resolved values of each layer, by its parameters. */
    this.understood = new Map();
    this.write = settled(250, () => this.put("replaceState"));
    this.isHeld = false;
    addEventListener("popstate", () => {
      this.write.cancel();
      const { renderer } = this.state;
      this.state = fromHash(location.hash);
      // A canvas that has one kind of context never gets another.
      if (this.state.renderer !== renderer) return location.reload();
      this.tell("layers", "view", "tab", "works");
    });
  }

  on(listener) {
    this.listeners.add(listener);
  }

  tell(...changed) {
    for (const listener of this.listeners) listener(new Set(changed));
  }

  put(how) {
    const hash = toHash(this.state);
    if (hash !== location.hash) history[how](null, "", hash);
  }

  /** Puts the choice into the address now. */
  save() {
    this.write.cancel();
    this.put("replaceState");
  }

  /** A choice that Back undoes. */
  choose(change, ...changed) {
    this.write.cancel();
    this.isHeld = false;
    // Moves since the last change belong to the entry before.
    this.put("replaceState");
    change(this.state);
    this.put("pushState");
    this.tell(...changed);
  }

  /** A choice that changes while a slider is held: one step for Back, which `choose` or `release` ends. */
  hold(change, ...changed) {
    if (!this.isHeld) this.choose(change, ...changed);
    else {
      change(this.state);
      this.write();
      this.tell(...changed);
    }
    this.isHeld = true;
  }

  release() {
    this.isHeld = false;
  }

  /** A correction of what cannot be shown: no step of its own. */
  correct(change) {
    this.write.cancel();
    change(this.state);
    this.put("replaceState");
  }

  /** A move of the view: it is in the address, but no step of its own. */
  viewed(view, span) {
    Object.assign(this.state, { x: view.x, y: view.y, span });
    this.write();
  }

  /** The fault of layers together: `{ layer, error }`, or nothing. */
  async understandTogether(layers) {
    if (layers.length === 1 || worldIn(layers) || layers.every((layer) => !layer.clear.trim())) return null;
    try {
      await askJson("/v1/count", { body: togetherBody(layers) });
      return null;
    } catch (error) {
      const [, layer] = /^layers\[(\d+)\]/.exec(error.faults?.[0]?.field ?? "") ?? [];
      return { layer: Number(layer ?? 0), error };
    }
  }

  /** Sees that the layers are those of the world that was chosen, or of none. */
  async settleWorld() {
    const { world, worldSeed, layers } = this.state;
    const held = worldIn(layers);
    if ((held?.name ?? "") === world && (held?.seed ?? "") === (world && worldSeed)) return;
    const settled = world ? await layersOfWorld(world, worldSeed) : [{ ...LAYER }];
    if (this.state.world === world && this.state.worldSeed === worldSeed) this.state.layers = settled;
  }

  /** Leaves the world that is shown, if one is, for a layer of its own. */
  leaveWorld() {
    if (!this.state.world) return;
    Object.assign(this.state, { world: "", worldSeed: "", layers: [{ ...LAYER }] });
  }

  /** The server's understanding of a layer: `{ spacing, density, least_distance, … }`. */
  understand(layer) {
    if (layer.world) return layer.understood;
    const query = joined(setOf(layer));
    const known = this.understood.get(query);
    if (known) return known;
    // A box of no size has no points to count.
    const asked = askJson(`/v1/count?bbox=0,0,1e-300,1e-300&${query}`).then((answer) => answer.query);
    if (this.understood.size > 200) this.understood.clear();
    this.understood.set(query, asked);
    asked.catch(() => this.understood.delete(query));
    return asked;
  }
}
