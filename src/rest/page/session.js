// What is chosen, kept in step with the address and with what the server makes of it.

import { askJson } from "./api.js";
import { joined, setOf } from "./query.js";
import { fromHash, toHash } from "./state.js";
import { settled } from "./dom.js";

/** One choice at a time; `listeners` hear what has changed: `layers`, `view`, `tab`, `works`. */
export class Session {
  constructor() {
    this.state = fromHash(location.hash);
    this.listeners = new Set();
    /** What the server makes of each layer, by its parameters. */
    this.understood = new Map();
    this.write = settled(250, () => this.put("replaceState"));
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

  /** A choice that Back undoes. */
  choose(change, ...changed) {
    this.write.cancel();
    // What was only moved since is part of the entry before.
    this.put("replaceState");
    change(this.state);
    this.put("pushState");
    this.tell(...changed);
  }

  /** A move of the view: it is in the address, but no step of its own. */
  viewed(view, span) {
    Object.assign(this.state, { x: view.x, y: view.y, span });
    this.write();
  }

  /** The server's understanding of a layer: `{ spacing, density, least_distance, … }`. */
  async understand(layer) {
    const query = joined(setOf(layer));
    if (!this.understood.has(query)) {
      // In a field there may be no point for long; a box of no size has none to count.
      const path = layer.field ? "/v1/count?bbox=0,0,1e-300,1e-300" : "/v1/nearest?at=0,0&k=1";
      const { query: understood } = await askJson(`${path}&${query}`);
      if (this.understood.size > 200) this.understood.clear();
      this.understood.set(query, understood);
    }
    return this.understood.get(query);
  }
}
