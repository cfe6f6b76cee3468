// What repeats without a seam, to take away: a period of the points of a layer, or a mask for dithering.

import { ask, askJson } from "./api.js";
import { byId, contextOf, counted } from "./dom.js";
import { setOptions } from "./form.js";
import { choicesOf } from "./profiles.js";
import { joined } from "./query.js";

/** The sides of masks, in pixels, and the one to begin with. */
const SIDES = ["64", "128", "256", "512"];
const STANDARD = "128";
/** Periods of more points are not offered here, but for the smallest one. */
const MOST_POINTS = 60_000;
/** The height of the picture, in pixels, which is twice as wide: two copies of a period lie side by side. */
const HEIGHT = 240;

export class Repeat {
  /** `changed()` hears that another size is chosen. */
  constructor(changed) {
    this.sizes = byId("repeat-size");
    this.sizes.addEventListener("change", changed);
    /** The map of the layer, or the smallest that its profile has: it has the shortest periods. */
    this.map = "";
  }

  /** The path of what repeats, `tile` or `mask`, without a format. */
  path(/** @type {string} */ what, /** @type {import("./state.js").Layer} */ { profile, alpha, seed, warp }) {
    const pairs = [["profile", profile], ["alpha", alpha], ["map", this.map], ["seed", seed.trim()]].filter(([, value]) => value);
    const size = this.sizes.value;
    if (what === "mask") return `/v1/mask.png?${joined([["size", SIDES.includes(size) ? size : STANDARD], ...pairs])}`;
    if (warp) pairs.push(["warp", warp]);
    return `/v1/points?${joined([["periodic", size || "1"], ["spacing", "1"], ...pairs])}`;
  }

  /** Offers the sizes that there are, and draws copies of the one that is chosen; returns its number of points. */
  async show(/** @type {string} */ what, /** @type {import("./state.js").Layer} */ layer, /** @type {AbortSignal} */ signal) {
    const { profiles } = await askJson("/v1/profiles", { signal });
    const { alpha, maps } = choicesOf(profiles, { ...layer, map: "" });
    this.map = layer.map || maps[0];
    await (what === "mask" ? this.offer(SIDES.map((side) => [side, `${side} × ${side} pixels`]), STANDARD) : this.periods({ ...layer, alpha }, signal));
    const path = this.path(what, layer);
    const answer = await ask(what === "mask" ? path : `${path}&format=png&size=${HEIGHT}`, { signal });
    const count = Number(answer.headers.get("strew-count"));
    const copy = await createImageBitmap(await answer.blob());
    const context = contextOf(byId("repeat-picture"));
    context.fillStyle = /** @type {CanvasPattern} */ (context.createPattern(copy, "repeat"));
    context.clearRect(0, 0, 2 * HEIGHT, HEIGHT);
    context.fillRect(0, 0, 2 * HEIGHT, HEIGHT);
    byId("repeat-note").textContent = what === "mask"
      ? "Repeat it over a picture, pixel by pixel: a pixel turns white where its gray is above the threshold."
      : `${counted(count)} on a square of ${Math.sqrt(Number(this.sizes.value))} mean spacings. Its copies, two of them here, join without a seam.`;
    return count;
  }

  /** Offers sizes; the one that was chosen stays if it is among them. */
  offer(sizes, standard) {
    const chosen = sizes.some(([size]) => size === this.sizes.value) ? this.sizes.value : standard;
    setOptions(this.sizes, sizes, chosen);
  }

  async periods({ profile, alpha }, signal) {
    const { periods } = await askJson(`/v1/periods?${joined([["profile", profile], ["alpha", alpha], ["map", this.map], ["most", "12"]])}`, { signal });
    const counts = periods.map(({ points }) => points).filter((points, i) => i === 0 || points <= MOST_POINTS);
    this.offer(counts.map((points) => [String(points), counted(points)]), String(counts[0]));
  }
}
