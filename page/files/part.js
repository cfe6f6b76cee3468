// What the plane's page tells its parts: a part overrides the events that it needs.

/**
 * A part of the page. `main.js` calls its methods as things happen; each does nothing unless a part
 * has its own.
 */
export class Part {
  /** The view has moved, by hand or by a choice: what was known about the points in view is out of date. */
  moved() {}

  /** All points in view are painted, and nothing has moved for a quarter of a second. */
  rested() {}

  /**
   * The server has understood the layers, which are shown from now on.
   * @param {import("./state.js").Layer[]} layers
   * @param {import("./session.js").Understood[]} understood The server's values of each layer.
   */
  shown(layers, understood) {}

  /** Another theme is in use: what was painted in colors of the last one is painted again. */
  themed() {}

  /**
   * A tab was opened, perhaps the one that was open before.
   * @param {string} tab
   */
  opened(tab) {}

  /**
   * The plane was tapped.
   * @param {[number, number]} at In CSS pixels from the canvas's corner at the top left.
   */
  tapped(at) {}

  /**
   * The mouse is over the plane.
   * @param {[number, number] | null} at As for `tapped`; `null` where it has left.
   */
  hovered(at) {}
}
