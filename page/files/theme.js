// Light, dark, or as the system has it; and the colors that the painters need as numbers.

import { icon } from "./dom.js";
import { COLOR_NAMES } from "./state.js";

const KEY = "strew-theme";
const MOON = "M12 3a9 9 0 1 0 9 9 7 7 0 0 1-9-9z";

/** A button for it, which begins with what was chosen before; `changed` hears of every change, the system's too. */
export function watchTheme(button, changed) {
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const set = (theme) => {
    if (theme) root.dataset.theme = theme;
    else delete root.dataset.theme;
  };
  button.append(icon(MOON));
  set(remembered());
  const tell = () => {
    button.setAttribute("aria-pressed", String(isDark()));
    changed();
  };
  button.addEventListener("click", () => {
    const theme = isDark() ? "light" : "dark";
    set(theme);
    remembered(theme);
    tell();
  });
  dark.addEventListener("change", tell);
  tell();
}

/** The theme that the browser remembers, another one from now on if it is given; none where pages may keep nothing. */
function remembered(theme = "") {
  try {
    if (theme) localStorage.setItem(KEY, theme);
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

/** Red, green and blue of a color as browsers write it, from 0 to 1. */
function channels(color) {
  return (color.match(/[\d.]+/g) ?? []).slice(0, 3).map((v) => Number(v) / 255);
}

/** Red, green and blue from 0 to 1 as canvases take a color. */
export function cssOf(rgb) {
  return `rgb(${rgb.map((v) => Math.round(v * 255)).join(" ")})`;
}

/** Whether the theme of now is dark. */
export function isDark() {
  const { theme } = document.documentElement.dataset;
  return theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** What an element of a class and a style computes to. */
function probed(className, style, /** @type {"color" | "backgroundColor"} */ name) {
  const probe = document.createElement("i");
  probe.className = className;
  Object.assign(probe.style, style);
  document.body.append(probe);
  const { [name]: color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

/**
 * The ground and the colors of layers in the theme of now. Layers that are a picture are dark on light in any theme:
 * a face in negative is no face.
 */
export function palette(layers = []) {
  const style = layers.some((layer) => layer.paper) ? { colorScheme: "light" } : {};
  const numbers = (/** @type {string} */ name) => channels(probed(name, style, "backgroundColor"));
  return { ground: numbers("probe-ground"), colors: COLOR_NAMES.map((_, i) => numbers(`swatch-${i}`)) };
}

/** A color of the theme as red, green and blue from 0 to 1. */
export function themeNumbers(name) {
  return channels(themeColor(name));
}

/** A color of the theme as CSS, for drawing on canvases. */
export function themeColor(name) {
  return probed("probe", { color: `var(--${name})` }, "color");
}
