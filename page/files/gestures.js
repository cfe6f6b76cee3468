// What moves a view: mouse, pen, fingers and keys; and the buttons on top of a page, nearer, farther, home, light or dark.

import { byId, icon } from "./dom.js";
import { followPointers, followWheel, placeOf } from "./hands.js";
import { parsePlace } from "./place.js";
import { watchTheme } from "./theme.js";

/** How far a key moves the view, as a share of its shorter side; with Shift a whole one. */
const STEP = 0.15;

/** Moves and zooms a plane as two fingers do. */
export function pinch(plane, { was, is }) {
  plane.drag(is.middle[0] - was.middle[0], is.middle[1] - was.middle[1]);
  plane.zoom(is.apart / was.apart, is.middle);
}

/** Lets a canvas move its plane; `tapped(at)` and `hovered(at)` get CSS pixels, or `null` on leaving. */
export function moveBy(canvas, plane, { tapped, hovered }) {
  followPointers(canvas, {
    tapped, hovered,
    moved: (step) => {
      if (step.was) pinch(plane, step);
      else if (step.fingers === 1 && step.isDrag) plane.drag(step.dx, step.dy);
    },
  });
  followWheel(canvas, (factor, at) => plane.zoom(factor, at));

  canvas.addEventListener("dblclick", (event) => {
    // The taps before meant the zoom, not a point.
    tapped(null);
    plane.zoom(event.shiftKey ? 0.5 : 2, placeOf(event, canvas));
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

/**
 * Has the form with coordinates lead to a place: `go({ x, y })` returns why it cannot be looked at, or nothing, and `say` hears
 * what is wrong.
 */
export function jumps(say, go) {
  const field = byId("jump-at");
  byId("jump").addEventListener("submit", (event) => {
    event.preventDefault();
    const [x, y] = field.value.split(/[,;]|\s+/).filter(Boolean).map(parsePlace);
    const wrong = x && y ? go({ x, y }) : "is not a place. Type two numbers, such as 1e12, -3.5.";
    field.setAttribute("aria-invalid", String(Boolean(wrong)));
    say(wrong && `“${field.value}” ${wrong}`);
  });
}

const ICONS = {
  closer: "M12 5v14M5 12h14",
  farther: "M5 12h14",
  home: "M3 11.5 12 4l9 7.5M6 10v10h12V10",
};
const NEARER = 1.5;

/** Makes the tools work on a view; `home()` leads back to where it begins, `themed()` hears of other colors. */
export function tools(view, home, themed) {
  for (const [id, path] of Object.entries(ICONS)) byId(id).append(icon(path));
  byId("closer").addEventListener("click", () => view.zoom(NEARER));
  byId("farther").addEventListener("click", () => view.zoom(1 / NEARER));
  byId("home").addEventListener("click", home);
  watchTheme(byId("theme"), themed);
}
