// Makes points off the page's own thread: a message is answered by the points of a window.

import { made } from "./made.js";

addEventListener("message", ({ data: { id, method, seed, window } }) => {
  const answer = made(method, seed, window);
  postMessage({ id, ...answer }, { transfer: [answer.points.buffer] });
});
