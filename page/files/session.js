// The choices on the page, kept in step with the address and with the server's resolved values.

import { Problem, askJson } from "./api.js";
import { joined, setOf, togetherBody, worldIn } from "./query.js";
import { LAYER, fromHash, toHash } from "./state.js";
import { settled } from "./dom.js";
import { layersOfWorld } from "./worlds.js";

/** @typedef {import("./place.js").Place} Place */
/** @typedef {import("./state.js").Layer} Layer */
/** @typedef {import("./state.js").State} State */
/** @typedef {"layers" | "picked" | "view" | "tab"} Changed */

/**
 * The server's values of a layer, everything filled in.
 * @typedef {Api.Query & { spacing: number, density: number, least_distance: number }} Understood
 */

/** One choice at a time; listeners hear what has changed. */
export class Session {
  constructor() {
    this.state = fromHash(location.hash);
    /** @type {Set<(changed: Set<Changed>) => void>} */
    this.listeners = new Set();
    /**
     * The server's values of each layer, by its parameters.
     * @type {Map<string, Promise<Understood>>}
     */
    this.understood = new Map();
    this.write = settled(250, () => this.put("replaceState"));
    this.isHeld = false;
    addEventListener("popstate", () => {
      this.write.cancel();
      this.state = fromHash(location.hash);
      this.tell("layers", "view", "tab");
    });
  }

  /** @param {(changed: Set<Changed>) => void} listener */
  on(listener) {
    this.listeners.add(listener);
  }

  /** @param {Changed[]} changed */
  tell(...changed) {
    for (const listener of this.listeners) listener(new Set(changed));
  }

  /** @param {"pushState" | "replaceState"} how */
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
  choose(/** @type {(state: State) => void} */ change, /** @type {Changed[]} */ ...changed) {
    this.write.cancel();
    this.isHeld = false;
    // Moves since the last change belong to the entry before.
    this.put("replaceState");
    change(this.state);
    this.put("pushState");
    this.tell(...changed);
  }

  /** A choice that changes while a slider is held: one step for Back, which `choose` or `release` ends. */
  hold(/** @type {(state: State) => void} */ change, /** @type {Changed[]} */ ...changed) {
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
  correct(/** @type {(state: State) => void} */ change) {
    this.write.cancel();
    change(this.state);
    this.put("replaceState");
  }

  /** A move of the view: it is in the address, but no step of its own. */
  viewed(/** @type {{ x: Place, y: Place }} */ view, /** @type {number} */ span) {
    Object.assign(this.state, { x: view.x, y: view.y, span });
    this.write();
  }

  /** The fault of layers together: `{ layer, error }`, or nothing. */
  async understandTogether(/** @type {Layer[]} */ layers) {
    if (layers.length === 1 || worldIn(layers) || layers.every((layer) => !layer.clear.trim())) return null;
    try {
      await askJson("/v1/count", { body: togetherBody(layers) });
      return null;
    } catch (error) {
      const [, layer] = /^layers\[(\d+)\]/.exec((error instanceof Problem && error.faults[0]?.field) || "") ?? [];
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

  /**
   * The server's understanding of a layer.
   * @param {Layer} layer
   * @returns {Understood | Promise<Understood>}
   */
  understand(layer) {
    if (layer.world) return layer.understood;
    const query = joined(setOf(layer));
    const known = this.understood.get(query);
    if (known) return known;
    // A box of no size has no points to count.
    const asked = askJson(`/v1/count?bbox=0,0,1e-300,1e-300&${query}`).then(({ query: all }) => /** @type {Understood} */ (all));
    if (this.understood.size > 200) this.understood.clear();
    this.understood.set(query, asked);
    asked.catch(() => this.understood.delete(query));
    return asked;
  }
}
