// A figure of the essay on its stage: it begins to move when it comes into view, rests while it is out of view, and
// takes pointers and keys.

import { Gone, Problem, ask, wordsOf } from "../api.js";
import { byId } from "../dom.js";
import { placeOf } from "../hands.js";
import { fitted } from "../view.js";
import { nearest, nextOf } from "./pattern.js";
import { forget, palette } from "./pen.js";

/** The least time between two frames, in seconds: figures are calm, and processors may be slow. */
const FRAME = 1 / 32;
/** The longest step, in seconds: after a pause nothing jumps. */
const LONGEST = 0.1;
/** The share of a figure that has to be in view. */
const SHARE = 0.4;
/** The pixels of a drag over all values of a number. */
const SWEEP = 320;

const lessMotion = matchMedia("(prefers-reduced-motion: reduce)");

/**
 * A figure has `draw(context, width, height, colors)`, and where it moves `step(seconds)`, which returns whether it goes on,
 * `finish()`, which leads to its last frame, and `restart()`. Where its canvas can have the focus, `touched([x, y])` hears of
 * pointers in pixels and `moved([right, up])` of arrow keys: they look at the nearest of its points in the first panel, and at
 * the next one.
 */
export class Figure {
  /** @type {Stage} */
  stage;
  /** @type {import("./pen.js").Panel[]} */
  panels;
  /** @type {number[][]} */
  points = [];
  /** @type {number[]} */
  point;
  seconds = 0;

  touched(at) {
    const [panel] = this.panels;
    if (this.points.length > 0 && panel.holds(at)) this.look(nearest(this.points, panel.from(at)));
  }

  moved(step) {
    if (this.point) this.look(nextOf(this.points, this.point, step) ?? this.point);
  }

  /** Looks at a point that was chosen. */
  look(point) {
    this.point = point;
    this.tell();
  }

  /** Says what is seen. */
  tell() {}
}

export class Stage {
  constructor(/** @type {string} */ id, /** @type {any} */ figure) {
    this.id = id;
    this.figure = figure;
    this.isSeen = false;
    this.isPaused = false;
    this.isOver = !figure.step;
    this.last = 0;
    figure.stage = this;
    this.element = byId(id);
    this.canvas = /** @type {HTMLCanvasElement} */ (this.element.querySelector("canvas"));
    this.said = this.element.querySelector(".said");
    this.button = this.element.querySelector(".play");
    this.button?.addEventListener("click", () => this.press());
    if (this.canvas.tabIndex === 0) this.listen();
    if (lessMotion.matches) this.finish();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    new IntersectionObserver(([entry]) => this.seen(entry.isIntersecting), { threshold: SHARE }).observe(this.canvas);
    this.show();
  }

  get isMoving() {
    return this.isSeen && !this.isPaused && !this.isOver;
  }

  seen(isSeen) {
    this.isSeen = isSeen;
    this.go();
  }

  /** Has frames drawn while the figure moves. */
  go() {
    this.show();
    if (!this.isMoving || this.frame) return;
    this.last = performance.now();
    this.frame = requestAnimationFrame((now) => this.step(now));
  }

  step(now) {
    this.frame = 0;
    if (!this.isMoving) return;
    const seconds = (now - this.last) / 1000;
    if (seconds >= FRAME) {
      this.last = now;
      if (!this.figure.step(Math.min(LONGEST, seconds))) this.isOver = true;
      this.draw();
    }
    if (this.isOver) this.show();
    else this.frame = requestAnimationFrame((next) => this.step(next));
  }

  /** Moves again, after the visitor has taken over. */
  goOn() {
    this.isOver = false;
    this.go();
  }

  finish() {
    this.figure.finish?.();
    this.isOver = true;
  }

  /** The button pauses, goes on, and plays what is over again. */
  press() {
    if (this.isOver) {
      this.figure.restart();
      Object.assign(this, { isOver: false, isPaused: false });
    } else {
      this.isPaused = !this.isPaused;
    }
    this.isSeen = true;
    this.go();
    this.draw();
  }

  show() {
    this.element.dataset.state = this.isOver ? "over" : this.isMoving ? "moving" : "resting";
    if (!this.button) return;
    this.button.textContent = this.isOver ? "Play again" : this.isPaused ? "Play" : "Pause";
  }

  /** The visitor has taken over: the figure moves no further by itself, and what it says is read out. */
  take() {
    if (!this.isOver) this.finish();
    this.said?.setAttribute("aria-live", "polite");
    this.show();
  }

  listen() {
    const { canvas, figure } = this;
    const touch = (event) => {
      this.take();
      figure.touched(placeOf(event, canvas));
      this.draw();
    };
    canvas.addEventListener("pointerdown", touch);
    canvas.addEventListener("pointermove", (event) => (event.pointerType !== "mouse" || event.buttons > 0) && touch(event));
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!step) return;
      event.preventDefault();
      this.take();
      figure.moved(step);
      this.draw();
    });
  }

  /** Binds a slider of the figure; `words(value)` is its value in words. */
  slider(id, words, changed) {
    const input = /** @type {HTMLInputElement} */ (byId(id));
    const shown = /** @type {HTMLElement} */ (this.element.querySelector(`output[for="${id}"]`));
    const numbers = /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll(`[data-drag="${id}"]`));
    const follow = () => {
      for (const one of [shown, ...numbers]) one.textContent = words(Number(input.value));
      input.setAttribute("aria-valuetext", shown.textContent);
    };
    for (const number of numbers) draggable(number, input);
    input.addEventListener("input", () => {
      this.take();
      follow();
      changed(Number(input.value));
      this.draw();
    });
    follow();
    return {
      set(value) {
        input.value = String(value);
        follow();
      },
    };
  }

  /** Binds buttons of which one is pressed: `data-value` is what they choose. The figure begins again. */
  choices(id, changed) {
    const buttons = [...byId(id).querySelectorAll("button")];
    for (const button of buttons) {
      button.addEventListener("click", () => {
        for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
        changed(button.dataset.value);
        if (lessMotion.matches) this.finish();
        else Object.assign(this, { isOver: false, isPaused: false });
        this.go();
        this.draw();
      });
    }
  }

  /** What the canvas shows, for those who do not see it. */
  name(/** @type {string} */ text) {
    if (this.canvas.getAttribute("aria-label") !== text) this.canvas.setAttribute("aria-label", text);
  }

  say(text) {
    if (this.said && this.said.textContent !== text) this.said.textContent = text;
  }

  draw() {
    const { context, width, height } = fitted(this.canvas);
    // Before its style is there a canvas has next to no size.
    if (width >= 60 && height >= 40) this.figure.draw(context, width, height, palette());
  }

  themed() {
    forget();
    this.draw();
  }

  /**
   * The answer to a request as JSON, of the newest request only: an older one returns nothing. Waits for a server that
   * is away or busy, and says so; what the server refuses is said and returns nothing.
   */
  async fetch(path) {
    const mine = (this.turn = (this.turn ?? 0) + 1);
    for (;;) {
      try {
        const answer = await (await ask(path)).json();
        return mine === this.turn ? answer : null;
      } catch (error) {
        if (mine !== this.turn) return null;
        const isBusy = error instanceof Problem && error.isPassing;
        if (isBusy) this.say("The server is busy. This figure tries again.");
        else if (error instanceof Gone) this.say("The server does not answer. This figure waits until it does.");
        else {
          this.say(`The server refused: ${wordsOf(error)}`);
          return null;
        }
        await new Promise((later) => setTimeout(later, 1000 * Math.max(1, isBusy ? error.retryAfter : 1)));
      }
    }
  }
}

/** Has a number in the text move its slider when it is dragged: from end to end in as many pixels as a finger goes. */
function draggable(number, input) {
  let at = 0;
  number.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    number.setPointerCapture(event.pointerId);
    at = Number(input.value);
  });
  number.addEventListener("pointermove", (event) => {
    if (event.buttons === 0) return;
    at += (event.movementX * (input.max - input.min)) / SWEEP;
    input.value = String(at);
    input.dispatchEvent(new Event("input"));
  });
}
