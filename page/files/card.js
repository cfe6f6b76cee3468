// A point that is pointed at: its card, and its place and neighbors above the plane.

import { askJson, isAborted, wordsOf } from "./api.js";
import { byId, make, settled, spoken } from "./dom.js";
import { decimalsFor, distance, formatPlace, moved, parsePlace, toNumber } from "./place.js";
import { attributesOf, joined, setOf, worldPairs } from "./query.js";
import { themeColor } from "./theme.js";
import { fitted } from "./view.js";

/** How near a pointer has to be to a point, in CSS pixels; a finger or a key may miss by more. */
const HOVER = 14;
const TAP = 48;
const NEIGHBORS = 8;
/** The room beside the card at the edge of the plane, and above and below it, where the page's buttons and numbers are. */
const EDGE = 10;
const ROWS = 64;
/** The room around a point for its ring. */
const RING = 14;

/** @typedef {import("./place.js").Place} Place */

export class Card {
  constructor(session, plane) {
    this.session = session;
    this.plane = plane;
    this.element = byId("card");
    this.over = byId("over");
    /** @type {{ x: Place, y: Place, layer: number } | null} */
    this.point = null;
    /** @type {{ self: any, near: any[], layer: import("./state.js").Layer, index: number } | null} */
    this.found = null;
    /** @type {AbortController | null} */
    this.abort = null;
    this.hasInk = false;
    this.isPinned = false;
    this.later = settled(120, (point) => this.tell(point));
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.point) return;
      const hadFocus = this.element.contains(document.activeElement);
      this.close();
      if (hadFocus) plane.canvas.focus();
    });
  }

  hovered(at) {
    if (this.isPinned) return;
    const point = at && this.plane.pointAt(at, HOVER);
    if (!point) return this.close();
    if (this.point && distance(point.x, this.point.x) === 0 && distance(point.y, this.point.y) === 0) return;
    this.point = point;
    this.found = null;
    this.element.hidden = true;
    this.draw();
    this.later(point);
  }

  tapped(at) {
    const point = at && this.plane.pointAt(at, TAP);
    if (!point) {
      this.close();
      if (at) this.say("No point is near here.");
      return;
    }
    this.isPinned = true;
    this.point = point;
    this.found = null;
    this.draw();
    this.later.cancel();
    this.tell(point);
  }

  shown() {
    this.close();
  }

  moved() {
    if (!this.isPinned) this.close();
    this.draw();
  }

  themed() {
    this.draw();
  }

  /** Says something to those who do not see the card. */
  say(words) {
    byId("said").textContent = words;
  }

  close() {
    this.later.cancel();
    this.abort?.abort();
    Object.assign(this, { point: null, found: null, isPinned: false });
    this.element.hidden = true;
    this.draw();
  }

  /** Asks the server who the point is and who is near, and shows it. */
  async tell(point) {
    this.abort?.abort();
    this.abort = new AbortController();
    const { signal } = this.abort;
    const layer = this.plane.look.layers[point.layer];
    const set = joined(setOf(layer, this.plane.keep));
    const decimals = decimalsFor(this.plane.look.spacings[point.layer]) + 9;
    const at = [point.x, point.y].map((v) => formatPlace(v, decimals)).join(",");
    try {
      if (layer.world) return await this.showOfWorld(point, layer, signal);
      const { neighbors } = await askJson(`/v1/nearest?at=${at}&k=${NEIGHBORS + 1}&${set}`, { signal });
      const known = await askJson(`/v1/points/${neighbors[0].id}?${set}`, { signal });
      this.found = { self: known.point, near: neighbors.slice(1), layer, index: point.layer };
      this.show();
    } catch (error) {
      if (isAborted(error)) return;
      this.element.replaceChildren(make("p", { class: "bad" }, wordsOf(error)));
      this.say(wordsOf(error));
      this.place();
    }
    this.draw();
  }

  /** Shows a point of a world: it is looked for in a box around it, with those that are near. */
  async showOfWorld(point, layer, signal) {
    const spacing = this.plane.look.spacings[point.layer];
    const reach = 3 * spacing;
    const decimals = decimalsFor(spacing) + 9;
    const box = [[point.x, -reach], [point.y, -reach], [point.x, reach], [point.y, reach]].map(([at, by]) => formatPlace(moved(at, by), decimals));
    const only = this.plane.look.layers.length > 1 ? [["only", layer.name]] : [];
    const query = joined([["bbox", box.join(",")], ...worldPairs(layer.world, this.plane.keep), ...only, ["limit", "500"], ["format", "json"]]);
    const { points } = await askJson(`/v1/points?${query}`, { signal });
    const away = (one, from) => Math.hypot(one.x - from.x, one.y - from.y);
    const here = { x: toNumber(point.x), y: toNumber(point.y) };
    const self = points.reduce((best, one) => (away(one, here) < away(best, here) ? one : best));
    const near = points.filter((one) => one !== self).map((one) => ({ ...one, distance: away(one, self) }));
    near.sort((a, b) => a.distance - b.distance);
    this.found = { self, near: near.slice(0, NEIGHBORS), layer, index: point.layer };
    this.show();
    this.draw();
  }

  show() {
    if (!this.found) return;
    const { self, near, layer, index } = this.found;
    const rows = [["x", String(self.x)], ["y", String(self.y)]];
    for (const name of attributesOf(layer)) {
      const value = self[name];
      if (value === undefined || value === null) continue;
      const text = typeof value === "number" ? String(Number(value.toPrecision(6))) : value;
      rows.push([name, name === "angle" ? `${text} (${Math.round((value * 180) / Math.PI)}°)` : text]);
    }
    if (self.block) rows.push(["block", self.block.join(", ")]);
    if (this.plane.look.layers.length > 1) rows.push(["layer", `${index + 1} ${layer.name ?? layer.profile}`]);
    const close = make("button", { type: "button", "aria-label": "Close", onclick: () => this.close() }, "✕");
    this.element.replaceChildren(
      make("header", {}, make("h2", {}, self.id), this.isPinned && close),
      make("dl", {}, rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)])),
      make("h3", {}, "Nearest neighbors"),
      make("table", {}, make("tbody", {}, near.map(({ id, distance: away }) => make("tr", {}, make("td", {}, id), make("td", {}, spoken(away, 5)))))),
    );
    this.element.dataset.id = self.id;
    this.place();
    if (!this.isPinned) return;
    const nearest = near.length > 0 ? `, its nearest neighbor ${spoken(near[0].distance, 4)} away` : "";
    this.say(`Point ${self.id} at ${spoken(self.x, 8)}, ${spoken(self.y, 8)}${nearest}. Escape closes.`);
  }

  /** Where a place of the world is on the canvas, in CSS pixels. */
  onCanvas(x, y) {
    const { view } = this.plane;
    return [view.width / 2 + distance(x, view.x) / view.unit, view.height / 2 - distance(y, view.y) / view.unit];
  }

  /** Puts the card into the corner that is farthest from its point. */
  place() {
    const { element, point } = this;
    if (!point) return;
    element.hidden = false;
    const { width, height } = this.plane.view;
    const [x, y] = this.onCanvas(point.x, point.y);
    element.style.left = `${x > width / 2 ? EDGE : Math.max(EDGE, width - element.offsetWidth - EDGE)}px`;
    // Where there is little room, the point matters more than the buttons.
    const last = height - element.offsetHeight;
    const top = y > height / 2 ? Math.min(ROWS, y - RING - element.offsetHeight) : Math.min(last - EDGE, Math.max(last - ROWS, y + RING));
    element.style.top = `${Math.max(EDGE, top)}px`;
  }

  /** Draws a ring around the point, and lines to its neighbors. */
  draw() {
    const { view } = this.plane;
    const { over } = this;
    if (!this.point && !this.hasInk) return;
    this.hasInk = Boolean(this.point);
    const { context } = fitted(over, view.width, view.height);
    if (!this.point) return;
    const [x, y] = this.onCanvas(this.point.x, this.point.y);
    context.strokeStyle = themeColor("accent");
    context.lineWidth = 1.5;
    for (const near of this.found?.near ?? []) {
      const [nx, ny] = this.onCanvas(parsePlace(String(near.x)), parsePlace(String(near.y)));
      context.globalAlpha = 0.7;
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(nx, ny);
      context.stroke();
    }
    context.globalAlpha = 1;
    context.lineWidth = 2.5;
    context.beginPath();
    context.arc(x, y, 9, 0, 2 * Math.PI);
    context.stroke();
    if (this.isPinned && this.found) this.place();
  }
}
