// Workers as functions: each message is answered by one with the same `id`.

/**
 * Calls of the worker at a path. It starts with the first call.
 * @param {string} path
 * @returns {(message: object, transferred?: Transferable[]) => Promise<any>}
 */
export function callsOf(path) {
  /** @type {Worker | null} */
  let worker = null;
  let next = 0;
  const waiting = new Map();
  const start = () => {
    const started = new Worker(path, { type: "module" });
    started.addEventListener("message", ({ data }) => {
      waiting.get(data.id)?.resolve(data);
      waiting.delete(data.id);
    });
    started.addEventListener("error", (event) => {
      for (const { reject } of waiting.values()) reject(new Error(event.message || "the worker does not start"));
      waiting.clear();
      worker = null;
    });
    return started;
  };
  return (message, transferred = []) => {
    worker ??= start();
    const at = worker;
    next += 1;
    const id = next;
    return new Promise((resolve, reject) => {
      waiting.set(id, { resolve, reject });
      at.postMessage({ ...message, id }, transferred);
    });
  };
}

const measures = callsOf("/page/measure_worker.js");

/** Measures points (x, y in turns, within a square of `side` world units). */
export function measure(/** @type {Float64Array<ArrayBuffer>} */ points, /** @type {number} */ side) {
  return measures({ points, side }, [points.buffer]);
}
