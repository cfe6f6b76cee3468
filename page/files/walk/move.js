// How the walker moves: keys, mouse, fingers, buttons that are held; and a slow flight along the trail until the visitor
// takes over.

import { moved } from "../place.js";
import { landFrom } from "./land.js";

/** Units a second, on foot and with Shift. */
const PACE = 5;
const RUN = 24;
/** Eyes are this high above the ground; a flight is higher. */
const EYE = 1.75;
const WING = 12;
/** Radians a second that keys turn, and for a pixel of a drag. */
const TURN = 1.3;
const DRAG = 0.0034;
/** A pointer that moves less than this many pixels taps. */
const TAP = 6;
/** The steepest look up or down, in radians. */
export const STEEPEST = 1.3;

const KEYS = {
  w: "forth", arrowup: "forth", s: "back", arrowdown: "back", a: "left", d: "right", arrowleft: "turnLeft",
  arrowright: "turnRight", q: "turnLeft", e: "turnRight", pageup: "lookUp", pagedown: "lookDown",
};

export class Walker {
  constructor(canvas, { x, y, yaw, pitch, isFlying }, tapped) {
    this.canvas = canvas;
    this.tapped = tapped;
    this.x = x;
    this.y = y;
    this.yaw = yaw;
    this.pitch = pitch;
    this.isFlying = isFlying;
    this.isFast = false;
    this.held = new Set();
    /** @type {number | null} */
    this.height = null;
    // Readers who prefer reduced motion see nothing move by itself; the button still flies.
    this.mayFly = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.isFlying &&= this.mayFly;
    this.listen();
  }

  listen() {
    const { canvas } = this;
    addEventListener("keydown", (event) => {
      const target = /** @type {Element} */ (event.target);
      this.isFast = event.shiftKey;
      if (event.ctrlKey || event.metaKey || event.altKey || target.closest?.("input, select")) return;
      // A button that was clicked keeps the focus, and its own keys.
      if ([" ", "Enter"].includes(event.key) && target.closest?.("button, a")) return;
      const move = KEYS[event.key.toLowerCase()];
      if (move) this.hold(move);
      else if (event.key === "Enter" && target === canvas) this.tapped(null);
      else return;
      event.preventDefault();
    });
    addEventListener("keyup", (event) => {
      this.isFast = event.shiftKey;
      this.held.delete(KEYS[event.key.toLowerCase()]);
    });
    addEventListener("blur", () => this.held.clear());
    const down = new Map();
    let travel = 0;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (down.size === 0) travel = 0;
      down.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = down.get(event.pointerId);
      if (!before) return;
      const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
      down.set(event.pointerId, [event.clientX, event.clientY]);
      travel += Math.abs(dx) + Math.abs(dy);
      if (travel <= TAP) return;
      this.take();
      // Two fingers walk, one looks around.
      if (down.size > 1) this.go(-dx * 0.04, dy * 0.08);
      else this.turn(-dx * DRAG, dy * DRAG);
    });
    const up = (event) => {
      if (!down.delete(event.pointerId) || down.size > 0) return;
      if (event.type === "pointerup" && travel <= TAP) this.tapped([event.clientX, event.clientY]);
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.take();
      this.go(0, -Math.sign(event.deltaY) * 3);
    }, { passive: false });
  }

  /** A button that moves for as long as it is held. */
  button(element, move) {
    const hold = (event) => {
      event.preventDefault();
      this.hold(move);
    };
    const free = () => this.held.delete(move);
    element.addEventListener("pointerdown", hold);
    for (const name of ["pointerup", "pointerleave", "pointercancel", "blur"]) element.addEventListener(name, free);
    element.addEventListener("keydown", (event) => [" ", "Enter"].includes(event.key) && hold(event));
    element.addEventListener("keyup", free);
    element.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  hold(move) {
    this.take();
    this.held.add(move);
  }

  /** The visitor takes over: the flight ends until its button is pressed. */
  take() {
    this.isFlying = false;
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

  /** Moves by some seconds; `heightAt` says where the ground is. */
  step(seconds, heightAt) {
    if (this.isFlying) this.fly(seconds);
    const way = (one, other) => (this.held.has(one) ? 1 : 0) - (this.held.has(other) ? 1 : 0);
    const pace = (this.isFast ? RUN : PACE) * seconds;
    this.turn(way("turnRight", "turnLeft") * TURN * seconds, way("lookUp", "lookDown") * TURN * seconds);
    if (this.held.size > 0) this.go(way("right", "left") * pace, way("forth", "back") * pace);
    const ground = heightAt(this);
    const aim = ground + (this.isFlying ? WING : EYE);
    const ease = 1 - Math.exp(-seconds * (this.isFlying ? 1.2 : 5));
    this.height = this.height === null ? aim : Math.max(ground + 1.2, this.height + (aim - this.height) * ease);
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
    this.turn(by * Math.min(1, 0.5 * seconds), (-0.09 - this.pitch) * Math.min(1, 0.6 * seconds));
    this.go(0, 6.5 * seconds);
  }
}
