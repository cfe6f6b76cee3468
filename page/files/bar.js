// The tools of a view on top of a page: nearer, farther, home, light or dark.

import { byId, icon } from "./dom.js";
import { watchTheme } from "./theme.js";

const ICONS = {
  closer: "M12 5v14M5 12h14",
  farther: "M5 12h14",
  home: "M3 11.5 12 4l9 7.5M6 10v10h12V10",
};
const STEP = 1.5;

/** Makes the tools work on a view; `home()` leads back to where it begins, `themed()` hears of other colors. */
export function tools(view, home, themed) {
  for (const [id, path] of Object.entries(ICONS)) byId(id).append(icon(path));
  byId("closer").addEventListener("click", () => view.zoom(STEP));
  byId("farther").addEventListener("click", () => view.zoom(1 / STEP));
  byId("home").addEventListener("click", home);
  watchTheme(byId("theme"), themed);
}
