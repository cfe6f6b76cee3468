// The first seconds of a first visit: the points of the plane begin where chance would put them, and pour into place.
// Where less motion is wanted only the words are shown, over the plane as it is.

import { byId, contextOf } from "./dom.js";
import { UNIT, mix, stirred } from "./hash.js";
import { sizesOf } from "./marks.js";
import { cssOf } from "./theme.js";
import { sized } from "./view.js";

/** Milliseconds for which the points stay where chance put them, and until the last of them is in place. */
const [HELD, POURED] = [500, 2000];
/** Milliseconds after which the words go away by themselves. */
const READ = 9000;
/** How far chance moves a point at most, in spacings: enough for the clumps and holes of white noise. */
const FAR = 2.6;
/** The share of the time that a point is on its way; the rest is how much later the last one begins. */
const SHARE = 0.6;

/** What a visitor does to end it. */
const KINDS = ["pointerdown", "wheel", "keydown"];

const CHANCE = "Random points clump and leave holes.";
const EVEN = "These points keep a distance, on a plane without an edge. Drag it.";

/** Numbers from 0 to 1 that depend on the address of a chunk and the number of a point in it alone. */
const chance = (chunk, k, salt) => stirred(stirred(mix(salt), chunk.cx) ^ k, chunk.cy) * UNIT;

const eased = (t) => t * t * (3 - 2 * t);

/** One pouring of the points of a plane: it begins with `begin` and ends by itself, or by `end`. */
export class Pour {
  constructor(plane) {
    this.plane = plane;
    this.canvas = byId("pour");
    this.caption = byId("caption");
    this.isRunning = false;
    /** The view that it began with. */
    this.seen = null;
    this.began = 0;
    this.timer = 0;
    /** @param {Event} event */
    this.stop = (event) => {
      const isOnTheWay = event instanceof KeyboardEvent && ["Tab", "Shift"].includes(event.key);
      return isOnTheWay ? this.rush() : this.end();
    };
  }

  /** Begins, if this is a first visit; `isStill` shows the last frame at once. */
  begin(isStill) {
    const root = document.documentElement;
    root.dataset.pour = isStill ? "still" : "running";
    this.seen = { ...this.plane.view };
    this.say(isStill ? EVEN : CHANCE);
    for (const kind of KINDS) addEventListener(kind, this.stop, { capture: true, passive: true });
    this.timer = setTimeout(() => this.end(), READ);
    if (isStill) return;
    this.isRunning = true;
    this.canvas.hidden = false;
    this.began = performance.now();
    this.frame(this.began);
  }

  say(words) {
    this.caption.textContent = words;
    this.caption.hidden = false;
  }

  frame(now) {
    if (!this.isRunning) return;
    const passed = Math.max(0, now - this.began);
    if (passed >= POURED) return this.rush();
    this.draw(Math.max(0, (passed - HELD) / (POURED - HELD)));
    requestAnimationFrame((next) => this.frame(next));
  }

  /** Draws all points on their way: `time` goes from 0 to 1. */
  draw(time) {
    const { plane: { view, look }, canvas } = this;
    sized(canvas, view.pixels);
    const context = contextOf(canvas);
    context.fillStyle = cssOf(look.ground);
    context.fillRect(0, 0, canvas.width, canvas.height);
    const pixel = view.unit / view.ratio;
    const radius = (sizesOf(look.layers, look.spacings, view.unit)[0] * view.ratio) / 2;
    const far = (FAR * look.spacing) / pixel;
    const half = [canvas.width / 2, canvas.height / 2];
    context.fillStyle = cssOf(look.colors[look.layers[0].color]);
    context.beginPath();
    this.plane.each((_, x, y, chunk, k) => {
      const later = chance(chunk, k, 1) * (1 - SHARE);
      const left = 1 - eased(Math.min(1, Math.max(0, (time - later) / SHARE)));
      const [turn, away] = [2 * Math.PI * chance(chunk, k, 2), far * Math.sqrt(chance(chunk, k, 3)) * left];
      const [px, py] = [half[0] + x / pixel + away * Math.cos(turn), half[1] - y / pixel + away * Math.sin(turn)];
      context.moveTo(px + radius, py);
      context.arc(px, py, radius, 0, 2 * Math.PI);
    }, far * pixel);
    context.fill();
    if (time > 0.7 && this.caption.textContent === CHANCE) this.say(EVEN);
  }

  /** The points are in place; the words stay for a while. */
  rush() {
    if (!this.isRunning) return;
    this.isRunning = false;
    this.canvas.hidden = true;
    this.say(EVEN);
    document.documentElement.dataset.pour = "done";
  }

  /** Ends at once, as when the visitor does something. */
  end() {
    this.rush();
    clearTimeout(this.timer);
    for (const kind of KINDS) removeEventListener(kind, this.stop, { capture: true });
    this.caption.hidden = true;
    this.seen = null;
  }

  /** Another view than the one that it began with ends it. */
  moved() {
    const { view } = this.plane;
    if (this.seen && ["unit", "width", "height"].some((name) => view[name] !== this.seen[name])) this.end();
  }

  /** Other points end it. */
  shown(layers) {
    if (this.seen && layers.length > 1) this.end();
  }

  themed() {
    if (!this.isRunning) return;
    this.rush();
  }
}
