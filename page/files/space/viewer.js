// The viewer: the place that is looked at, and the eye around it. A drag turns, a wheel or two fingers zoom, keys and
// buttons that are held fly.

import { Held, followPointers, followWheel } from "../hands.js";
import { moved } from "../place.js";
import { cameraOf } from "../walk/camera.js";
import { REACH, STEEPEST } from "./state.js";

/** Mean spacings a second; Shift makes it several times as many. */
const PACE = 7;
const RUN = 5;
/** Radians a second that keys turn, a second that the volume turns by itself, and a pixel of a drag. */
const TURN = 1.2;
const SLOWLY = 0.12;
const DRAG = 0.006;
/** Nearer to the place than this, in mean spacings, the eye looks around instead of circling it. */
const INSIDE = 1.5;

const KEYS = {
  w: "forth", s: "back", a: "left", d: "right", e: "up", q: "down", pageup: "up", pagedown: "down",
  arrowleft: "turnLeft", arrowright: "turnRight", arrowup: "turnUp", arrowdown: "turnDown",
};
const ZOOMS = { "+": 1.25, "=": 1.25, "-": 0.8, _: 0.8 };

export class Viewer {
  /** `changed()` hears of whatever the visitor does. */
  constructor(/** @type {HTMLCanvasElement} */ canvas, /** @type {import("./state.js").State} */ state, /** @type {() => void} */ changed) {
    this.canvas = canvas;
    this.state = state;
    this.changed = changed;
    /** The moves that are under way. */
    this.held = new Held();
    // Readers who prefer reduced motion see nothing move by itself; the button still turns.
    this.isTurning = state.isPlain && !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.listen();
  }

  listen() {
    const { canvas } = this;
    this.held.listen(canvas, KEYS, ({ key }, move) => {
      if (move) this.hold(move);
      else if (ZOOMS[key]) this.zoom(ZOOMS[key]);
      return Boolean(move || ZOOMS[key]);
    });
    followPointers(canvas, {
      moved: ({ dx, dy, fingers, was, is }) => {
        if (was && is) {
          // Half of the way, because the other finger reports its own.
          const step = (this.state.away + 4) / canvas.clientHeight / 2;
          this.go(-dx * step, 0, dy * step);
          this.zoom(is.apart / was.apart);
        } else if (fingers === 1) {
          const way = this.state.away > INSIDE ? 1 : -1;
          this.turn(way * dx * DRAG, -way * dy * DRAG);
          this.took();
        }
      },
    });
    followWheel(canvas, (factor) => this.zoom(factor));
  }

  /** A button that moves while it is held. */
  button(element, move) {
    const hold = (event) => {
      event.preventDefault();
      this.hold(move);
    };
    const free = () => this.held.delete(move);
    element.addEventListener("pointerdown", hold);
    for (const name of ["pointerup", "pointerleave", "pointercancel", "blur", "keyup"]) element.addEventListener(name, free);
    element.addEventListener("keydown", (event) => [" ", "Enter"].includes(event.key) && hold(event));
    element.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  hold(move) {
    this.held.add(move);
    this.took();
  }

  /** The visitor moves: nothing turns by itself until its button is pressed. */
  took() {
    this.isTurning = false;
    this.changed();
  }

  turn(yaw, pitch) {
    this.state.yaw = (this.state.yaw + yaw) % (2 * Math.PI);
    this.state.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.state.pitch + pitch));
  }

  /** Brings the eye nearer by a factor, up to the place itself. */
  zoom(factor) {
    const { state } = this;
    const away = (state.away + 1) / factor - 1;
    state.away = Math.max(0, Math.min(4 * REACH[1], away));
    this.took();
  }

  /** Moves by mean spacings to the right, ahead and up, as seen from the eye. */
  go(right, ahead, up) {
    const { spacing, at } = this.state;
    const eye = cameraOf(this.state, 1, 1);
    const along = (axis) => right * eye.right[axis] + ahead * eye.ahead[axis] + up * eye.up[axis];
    this.state.at = at.map((one, axis) => moved(one, along(axis) * Number(spacing)));
    this.took();
  }

  /** Moves by some seconds. */
  step(seconds) {
    if (this.isTurning) this.turn(SLOWLY * seconds, 0);
    if (this.held.size === 0) return;
    const { held } = this;
    this.turn(held.way("turnRight", "turnLeft") * TURN * seconds, held.way("turnUp", "turnDown") * TURN * seconds);
    const pace = PACE * (held.isFast ? RUN : 1) * seconds;
    this.go(held.way("right", "left") * pace, held.way("forth", "back") * pace, held.way("up", "down") * pace);
  }
}
