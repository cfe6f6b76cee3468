// Fields of a form that stay where they are: they are made once, and set again when the choice changes.

import { useKey } from "./api.js";
import { make } from "./dom.js";

/** Adds the line for what is wrong with the value of a control to its field. */
export function wrongAt(control) {
  control.closest(".field").append(make("p", { class: "note bad", id: `wrong-${control.id}`, role: "alert", hidden: true }));
}

/** Sets what a list offers, as keys or as pairs of a key and its words, and what is chosen. */
export function setOptions(list, options, value) {
  const pairs = options.map((option) => (Array.isArray(option) ? option : [option, option]));
  const text = JSON.stringify(pairs);
  if (list.dataset.options !== text) {
    list.replaceChildren(...pairs.map(([key, words]) => make("option", { value: key }, words)));
    list.dataset.options = text;
  }
  list.value = value;
}

/** Says what is wrong with the value of a field, at the field; no words if nothing is. */
export function fault(root, id, words) {
  const control = root.querySelector(`#${id}`);
  const line = root.querySelector(`#wrong-${id}`);
  if (!control || !line) return;
  if (line.textContent !== (words ?? "")) line.textContent = words ?? "";
  line.hidden = !words;
  control.setAttribute("aria-invalid", String(Boolean(words)));
  control.dataset.about ??= control.getAttribute("aria-describedby") ?? "";
  const about = [control.dataset.about, words && line.id].filter(Boolean).join(" ");
  if (about) control.setAttribute("aria-describedby", about);
  else control.removeAttribute("aria-describedby");
}

/** A form for a key, which stays in this tab; `used()` is called once there is one. */
export function keyForm(used) {
  const key = make("input", { type: "password", id: "key", "aria-label": "Key", autocomplete: "off", required: true });
  const use = (event) => {
    event.preventDefault();
    useKey(key.value);
    used();
  };
  return make("form", { class: "line", onsubmit: use }, key, make("button", { type: "submit" }, "Use this key"));
}
