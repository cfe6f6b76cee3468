// The worker that measures, as a function.

let worker = null;
let next = 0;
const waiting = new Map();

/** Measures points (x, y in turns, within a square of `side` world units). */
export function measure(points, side) {
  if (!worker) {
    worker = new Worker("/page/measure_worker.js", { type: "module" });
    worker.addEventListener("message", ({ data }) => {
      waiting.get(data.id)?.resolve(data);
      waiting.delete(data.id);
    });
    worker.addEventListener("error", (event) => {
      for (const { reject } of waiting.values()) reject(new Error(event.message || "the worker does not start"));
      waiting.clear();
      worker = null;
    });
  }
  next += 1;
  const id = next;
  return new Promise((resolve, reject) => {
    waiting.set(id, { resolve, reject });
    worker.postMessage({ id, points, side }, [points.buffer]);
  });
}
