// What a first visit opens with: a flight through the walk at dusk, over the whole window, and ways on. It is a picture at once,
// and moves where that is wanted and graphics hardware draws it.

import { byId, make } from "./dom.js";
import { glOn, isSoftware } from "./program.js";

/** Opens the flight; `ended()` hears that the plane is to be seen. */
export function openFlight(/** @type {() => void} */ ended) {
  const flight = byId("flight");
  flight.showModal();
  byId("flight-points").addEventListener("click", () => flight.close());
  flight.addEventListener("close", () => {
    delete document.documentElement.dataset.first;
    flight.querySelector("iframe")?.remove();
    ended();
  });
  const gl = matchMedia("(prefers-reduced-motion: reduce)").matches ? null : glOn(make("canvas"), {});
  if (!gl || isSoftware(gl)) return;
  const walk = make("iframe", { src: "/walk#scenery=1", tabindex: "-1", "aria-hidden": "true", inert: true });
  walk.addEventListener("load", () => {
    const { documentElement: root } = /** @type {Document} */ (walk.contentDocument);
    const show = () => root.dataset.state === "ready" && walk.classList.add("shown");
    new MutationObserver(show).observe(root, { attributes: true });
  });
  flight.prepend(walk);
}
