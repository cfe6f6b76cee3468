// What hands do on a canvas: pointers that are down, keys that are held, the wheel.

/** For what nothing hears of. */
const unheard = (..._) => {};
/** Pointers that moved less than this many pixels tap. */
const TAP = 5;

/**
 * Follows the pointers on a canvas. `moved` hears of a step by `dx`, `dy` of one of the `fingers` that are down, which is `at` a
 * place now, and where two are: where they `was` and `is` now; `isDrag` says that it is more than a tap. `lifted(isWhole)`
 * hears of a finger that goes, or whose way was cut off. All is in CSS pixels.
 */
export function followPointers(canvas, { moved, pressed = unheard, lifted = unheard, tapped = unheard, hovered = unheard }) {
  const down = new Map();
  let travel = 0;
  const pair = () => {
    const [a, b] = [...down.values()];
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], apart: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1 };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (down.size === 0) travel = 0;
    down.set(event.pointerId, placeOf(event, canvas));
    canvas.classList.add("held");
    pressed(placeOf(event, canvas), down.size);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    const now = placeOf(event, canvas);
    if (!before) {
      if (event.pointerType === "mouse") hovered(now);
      return;
    }
    const was = down.size === 2 ? pair() : null;
    down.set(event.pointerId, now);
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    travel += Math.abs(dx) + Math.abs(dy);
    moved({ at: now, dx, dy, fingers: down.size, was, is: was && pair(), isDrag: travel > TAP });
  });
  const up = (event) => {
    if (!down.delete(event.pointerId)) return;
    lifted(event.type === "pointerup");
    if (down.size > 0) return;
    canvas.classList.remove("held");
    if (event.type === "pointerup" && travel <= TAP) tapped(placeOf(event, canvas));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => hovered(null));
}

/** Where a pointer is on a canvas. */
export function placeOf(event, canvas) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

/** Calls `zoomed(factor, at)` as the wheel turns. */
export function followWheel(canvas, zoomed) {
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    const turn = Math.max(-240, Math.min(240, event.deltaY * lines));
    zoomed(Math.exp(-turn * (event.ctrlKey ? 0.01 : 0.0022)), placeOf(event, canvas));
  }, { passive: false });
}

/** The moves whose keys or buttons are held. */
export class Held extends Set {
  /** Whether Shift is held, too. */
  isFast = false;

  /** Listens to the `keys` of moves; `pressed(event, move)` returns whether it uses a key. */
  listen(target, keys, pressed) {
    const moveOf = ({ key }) => keys[key.toLowerCase()];
    target.addEventListener("keydown", (event) => {
      this.isFast = event.shiftKey;
      if (!event.ctrlKey && !event.metaKey && !event.altKey && pressed(event, moveOf(event))) event.preventDefault();
    });
    addEventListener("keyup", (event) => {
      this.isFast = event.shiftKey;
      this.delete(moveOf(event));
    });
    addEventListener("blur", () => this.clear());
  }

  /** 1 or −1 for one of two opposite moves, 0 for none or both. */
  way(one, other) {
    return Number(this.has(one)) - Number(this.has(other));
  }
}
