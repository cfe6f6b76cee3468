// How the walker moves: keys, mouse, fingers, sticks under thumbs; and a slow flight above the crowns, along the trail, until the
// visitor takes over.

import { Held, followPointers } from "../hands.js";
import { distance, moved } from "../place.js";
import { clearingNear, landFrom } from "./land.js";

/** Units a second: on foot, with Shift, with a stick pushed to its rim; in the air all are faster. */
const PACE = 5;
const RUN = 24;
const STRIDE = 9;
const ALOFT = 3;
/** Eyes are this high above the ground; in the air higher than the tallest crowns, which end at 20. */
const EYE = 1.75;
const WING = 26;
/** How far ahead a flight looks for higher ground. */
const AHEAD = [0, 25, 50];
/** A landing: the share of trees that is clear enough, units a second at least, and where the descent begins. */
const CLEAR = 0.04;
const GLIDE = 22;
const OVER = 5;
/** Seconds of a frame that keys and flights follow, so that no slow frame carries them far; a landing takes the time it takes. */
const LONGEST = 0.1;
/** Radians a second that keys turn, and for a pixel of a drag. */
const TURN = 1.3;
const DRAG = 0.0034;
/** The pitch of a view that is level, in radians. */
const LEVEL = -0.06;
/** The steepest look up or down, in radians. */
export const STEEPEST = 1.3;

const KEYS = {
  w: "forth", arrowup: "forth", s: "back", arrowdown: "back", a: "left", d: "right", arrowleft: "turnLeft",
  arrowright: "turnRight", q: "turnLeft", e: "turnRight", pageup: "lookUp", pagedown: "lookDown",
};

/** @typedef {import("../place.js").Place} Place */

export class Walker {
  constructor(canvas, start, tapped) {
    this.canvas = canvas;
    this.tapped = tapped;
    this.held = new Held();
    /** Where the sticks are pushed: to the right and forth, from −1 to 1. */
    this.walks = [0, 0];
    this.looks = [0, 0];
    /**
     * Where a landing ends, with the direction of the view from there.
     * @type {ReturnType<Walker["clearing"]> | null}
     */
    this.target = null;
    // Readers who prefer reduced motion see nothing move by itself; the button still flies.
    this.mayFly = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.begin(start);
    this.listen();
  }

  /**
   * Begins at a place. `isAloft` is in the air, `isFlying` moves along the trail by itself, `isAnywhere` lands in a
   * clearing nearby unless it flies.
   */
  begin({ x, y, yaw, pitch, isFlying, isAloft, isAnywhere }) {
    Object.assign(this, { x, y, yaw, pitch, height: null, target: null });
    this.isFlying = isFlying && this.mayFly;
    this.isAloft = isAloft || this.isFlying;
    if (isAnywhere && !this.isAloft) this.land();
  }

  listen() {
    const { canvas } = this;
    this.held.listen(globalThis, KEYS, ({ key, target }, move) => {
      const element = /** @type {Element} */ (target);
      // A button that was clicked keeps the focus, and its own keys.
      if (element.closest?.([" ", "Enter"].includes(key) ? "input, select, button, a" : "input, select")) return false;
      const isPick = !move && key === "Enter" && element === canvas;
      if (move) this.hold(move);
      else if (isPick) this.tapped(null);
      return Boolean(move) || isPick;
    });
    followPointers(canvas, {
      tapped: this.tapped,
      moved: ({ dx, dy, fingers, isDrag }) => {
        if (!isDrag) return;
        this.take();
        // Two fingers walk, one looks around.
        if (fingers > 1) this.go(-dx * 0.04, dy * 0.08);
        else this.turn(-dx * DRAG, dy * DRAG);
      },
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.take();
      this.go(0, -Math.sign(event.deltaY) * 3);
    }, { passive: false });
  }

  hold(move) {
    this.take();
    this.held.add(move);
  }

  /** The visitor takes over: what moved by itself stops, and stays as high as it is. */
  take() {
    this.isFlying = false;
    this.target = null;
  }

  /** Rises above the crowns and follows the trail. */
  rise() {
    Object.assign(this, { isAloft: true, isFlying: true, target: null });
  }

  /** Where the nearest clearing is, and the direction with the widest view from there. */
  clearing(few) {
    const { dx, dy, yaw } = clearingNear(landFrom([this.x.i, this.y.i]), this.x.f, this.y.f, few);
    return { x: moved(this.x, dx - this.x.f), y: moved(this.y, dy - this.y.f), yaw };
  }

  /** Stands in a clearing nearby. */
  land() {
    Object.assign(this, this.clearing(), { pitch: LEVEL, height: null, isAloft: false, isFlying: false, target: null });
  }

  /** Glides to the next clearing and descends into it; at once where less motion is wanted. */
  descend() {
    if (!this.mayFly) return this.land();
    this.isFlying = false;
    this.target = this.clearing(CLEAR);
  }

  turn(yaw, pitch) {
    this.yaw = (this.yaw + yaw) % (2 * Math.PI);
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.pitch + pitch));
  }

  /** Goes to the right and forth. */
  go(right, forth) {
    const [s, c] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    this.x = moved(this.x, forth * s + right * c);
    this.y = moved(this.y, forth * c - right * s);
  }

  /** Moves after some seconds; `heightAt` says where the ground is. */
  step(passed, heightAt) {
    const seconds = Math.min(LONGEST, passed);
    if (this.isFlying) this.fly(seconds);
    else if (this.target) this.glide(Math.min(1, passed), this.target);
    const { held } = this;
    const by = seconds * (this.isAloft ? ALOFT : 1);
    const pace = (held.isFast ? RUN : PACE) * by;
    const [[right, forth], [across, up]] = [this.walks, this.looks];
    this.turn((held.way("turnRight", "turnLeft") + across) * TURN * seconds, (held.way("lookUp", "lookDown") + up) * TURN * seconds);
    const walk = [held.way("right", "left") * pace + right * STRIDE * by, held.way("forth", "back") * pace + forth * STRIDE * by];
    if (walk.some(Boolean)) this.go(walk[0], walk[1]);
    const ground = heightAt(this);
    const aim = this.isAloft ? Math.max(ground, this.groundAhead()) + WING : ground + EYE;
    const ease = 1 - Math.exp(-passed * (this.isAloft || (this.height ?? 0) > ground + 3 ? 1.4 : 5));
    this.height = this.height === null ? aim : Math.max(ground + 1.2, this.height + (aim - this.height) * ease);
  }

  /** The highest ground on the next units ahead. */
  groundAhead() {
    const land = landFrom([this.x.i, this.y.i]);
    const [s, c] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    return Math.max(...AHEAD.map((away) => land.height(this.x.f + away * s, this.y.f + away * c)));
  }

  /** Moves towards the clearing to land in, and turns to its view; above it the descent begins. */
  glide(seconds, { x, y, yaw }) {
    const [dx, dy] = [distance(x, this.x), distance(y, this.y)];
    const away = Math.hypot(dx, dy);
    const share = Math.min(1, (Math.max(GLIDE, away) * seconds * 0.8) / Math.max(away, 1e-9));
    this.x = moved(this.x, dx * share);
    this.y = moved(this.y, dy * share);
    const by = ((yaw - this.yaw + 3 * Math.PI) % (2 * Math.PI) + 2 * Math.PI) % (2 * Math.PI) - Math.PI;
    const ease = Math.min(1, 1.2 * seconds);
    this.turn(by * ease, (LEVEL - this.pitch) * ease);
    if (away < OVER) this.isAloft = false;
    if (away < 0.01 && Math.abs(by) < 0.02) this.target = null;
  }

  /** Follows the trail, gently. */
  fly(seconds) {
    const corner = [this.x.i, this.y.i];
    const { trail } = landFrom(corner);
    const [x, y] = [this.x.f, this.y.f];
    const off = trail(x, y);
    const [gx, gy] = [trail(x + 1, y) - off, trail(x, y + 1) - off];
    const steep = Math.hypot(gx, gy) || 1e-9;
    const [s, c] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    const side = s * -gy + c * gx >= 0 ? 1 : -1;
    const back = Math.max(-0.9, Math.min(0.9, (-off / steep) * 0.04));
    const aim = [(side * -gy + back * gx) / steep, (side * gx + back * gy) / steep];
    const by = Math.atan2(aim[0] * c - aim[1] * s, aim[0] * s + aim[1] * c);
    this.turn(by * Math.min(1, 0.5 * seconds), (-0.14 - this.pitch) * Math.min(1, 0.6 * seconds));
    this.go(0, 9 * seconds);
  }
}

/** Pushes below this share of the radius are none, so that a resting thumb does nothing. */
const RESTING = 0.12;
/** How far the knob moves, in hundredths of its own size. */
const TRAVEL = 62;

/** Calls `pushed([right, up])`, each from −1 to 1, while a pointer is on an element; [0, 0] when it leaves. */
export function stick(element, pushed) {
  const knob = element.querySelector("i");
  let finger = null;
  const set = (x, y) => {
    knob.style.translate = `${x * TRAVEL}% ${-y * TRAVEL}%`;
    const long = Math.hypot(x, y);
    // A gentle push is slow: speed grows with the square.
    const speed = long < RESTING ? 0 : ((long - RESTING) / (1 - RESTING)) ** 2 / long;
    pushed([x * speed, y * speed]);
  };
  const follow = ({ clientX, clientY }) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    const [x, y] = [(2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height];
    const far = Math.max(1, Math.hypot(x, y));
    set(x / far, y / far);
  };
  element.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    if (finger !== null) return;
    finger = event.pointerId;
    element.setPointerCapture(finger);
    element.dataset.held = "";
    follow(event);
  });
  element.addEventListener("pointermove", (event) => event.pointerId === finger && follow(event));
  const free = (event) => {
    if (event.pointerId !== finger) return;
    finger = null;
    delete element.dataset.held;
    set(0, 0);
  };
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) element.addEventListener(name, free);
  element.addEventListener("contextmenu", (event) => event.preventDefault());
}
