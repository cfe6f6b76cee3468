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
    remember(theme);
    tell();
  });
  dark.addEventListener("change", tell);
  tell();
}

function remembered() {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

function remember(theme) {
  try {
    localStorage.setItem(KEY, theme);
  } catch { /* Then it is forgotten. */ }
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
function isDark() {
  const { theme } = document.documentElement.dataset;
  return theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The resolved color of an element's background, as red, green and blue from 0 to 1. */
function resolved(className, isPaper) {
  const probe = document.createElement("i");
  probe.className = className;
  if (isPaper) probe.style.colorScheme = "light";
  document.body.append(probe);
  const numbers = channels(getComputedStyle(probe).backgroundColor);
  probe.remove();
  return numbers;
}

/**
 * The ground and the colors of layers in the theme of now. Layers that are a picture are dark on light in any theme:
 * a face in negative is no face.
 */
export function palette(layers = []) {
  const isPaper = layers.some((layer) => layer.paper);
  return {
    ground: resolved("probe-ground", isPaper),
    colors: COLOR_NAMES.map((_, i) => resolved(`swatch-${i}`, isPaper)),
  };
}

/** A color of the theme as red, green and blue from 0 to 1. */
export function themeNumbers(name) {
  return channels(themeColor(name));
}

/** A color of the theme as CSS, for drawing on canvases. */
export function themeColor(name) {
  const probe = document.createElement("i");
  probe.className = "probe";
  probe.style.color = `var(--${name})`;
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}
