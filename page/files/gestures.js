// Mouse, pen, fingers and keys that move the plane.

/** How far a key moves the view, as a share of its shorter side; with Shift a whole one. */
const STEP = 0.15;
/** A pointer that moves less than this many pixels taps. */
const TAP = 5;

/** Lets a canvas move its plane; `tapped(at)` and `hovered(at)` get CSS pixels, or `null` on leaving. */
export function moveBy(canvas, plane, { tapped, hovered }) {
  const down = new Map();
  let travel = 0;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const pinch = () => {
    const [a, b] = [...down.values()];
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], apart: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1 };
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (down.size === 0) travel = 0;
    down.set(event.pointerId, at(event));
    canvas.classList.add("held");
  });

  canvas.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    const now = at(event);
    if (!before) {
      if (event.pointerType === "mouse") hovered(now);
      return;
    }
    const was = down.size === 2 ? pinch() : null;
    down.set(event.pointerId, now);
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    travel += Math.abs(dx) + Math.abs(dy);
    if (was) {
      const is = pinch();
      plane.drag(is.middle[0] - was.middle[0], is.middle[1] - was.middle[1]);
      plane.zoom(is.apart / was.apart, is.middle);
    } else if (down.size === 1 && travel > TAP) plane.drag(dx, dy);
  });

  const up = (event) => {
    if (!down.delete(event.pointerId) || down.size > 0) return;
    canvas.classList.remove("held");
    if (event.type === "pointerup" && travel <= TAP) tapped(at(event));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => hovered(null));

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    const turn = Math.max(-240, Math.min(240, event.deltaY * lines));
    plane.zoom(Math.exp(-turn * (event.ctrlKey ? 0.01 : 0.0022)), at(event));
  }, { passive: false });

  canvas.addEventListener("dblclick", (event) => {
    // The taps before meant the zoom, not a point.
    tapped(null);
    plane.zoom(event.shiftKey ? 0.5 : 2, at(event));
  });

  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const side = Math.min(plane.view.width, plane.view.height) * (event.shiftKey ? 1 : STEP);
    const moves = { ArrowLeft: [side, 0], ArrowRight: [-side, 0], ArrowUp: [0, side], ArrowDown: [0, -side] };
    const zooms = { "+": 1.25, "=": 1.25, "-": 0.8, _: 0.8, PageUp: 2, PageDown: 0.5 };
    if (moves[event.key]) plane.drag(...moves[event.key]);
    else if (zooms[event.key]) plane.zoom(zooms[event.key]);
    else if (event.key === "Enter" || event.key === " ") tapped([plane.view.width / 2, plane.view.height / 2]);
    else return;
    event.preventDefault();
  });
}
