// Shared by the modes of the laboratory: the window, sliders, addresses of requests.

import { make } from "../dom.js";
import { encoded } from "../state.js";

/** Half the side of the window of the plane, in grid units. */
export const REACH = 24;

/** A slider among the settings of a mode. */
export function range(works, name, label, [min, max, step], words) {
  const id = `works-${name}`;
  const said = make("span", { class: "soft" });
  const input = make("input", {
    type: "range", id, min, max, step,
    oninput: () => works.drag({ [name]: input.value }),
    onchange: () => works.choose({ [name]: input.value }),
  });
  /** @type {any} */ (input).follow = (value) => {
    input.value = value;
    said.textContent = words(Number(value));
    input.setAttribute("aria-valuetext", said.textContent);
  };
  return make("div", { class: "field", "data-name": name }, make("label", { for: id }, label, " ", said), input);
}

/** Brings the sliders of a mode up to date. */
export function follow(works, chosen) {
  for (const input of works.settings.querySelectorAll("input[type=range]")) {
    input.follow(chosen[input.id.replace("works-", "")]);
  }
}

/** The path of a request with its parameters. */
export function pathOf(path, parameters) {
  return `${path}?${parameters.map(([name, value]) => `${name}=${encoded(String(value))}`).join("&")}`;
}
