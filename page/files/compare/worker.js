// Makes points off the page's own thread: a message is answered by the points of a window, or by how long one takes.

import { made } from "./made.js";

addEventListener("message", ({ data: { id, method, seed, window } }) => {
  const source = made(method, seed);
  if (!window) return postMessage({ id, ...source.time() });
  const { points, isWhole, total } = source.window(window);
  postMessage({ id, points, isWhole, total }, { transfer: [points.buffer] });
});
