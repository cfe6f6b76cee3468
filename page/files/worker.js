// A worker as a function: each message is answered by one with the same `id`.

/** Calls of the worker at a path: `(message, transferred) => promise`. It starts with the first call. */
export function callsOf(path) {
  let worker = null;
  let next = 0;
  const waiting = new Map();
  const start = () => {
    worker = new Worker(path, { type: "module" });
    worker.addEventListener("message", ({ data }) => {
      waiting.get(data.id)?.resolve(data);
      waiting.delete(data.id);
    });
    worker.addEventListener("error", (event) => {
      for (const { reject } of waiting.values()) reject(new Error(event.message || "the worker does not start"));
      waiting.clear();
      worker = null;
    });
  };
  return (message, transferred = []) => {
    if (!worker) start();
    next += 1;
    const id = next;
    return new Promise((resolve, reject) => {
      waiting.set(id, { resolve, reject });
      worker.postMessage({ ...message, id }, transferred);
    });
  };
}
