// Downloads: how many points and bytes first, then the file.

import { ask, brokeOff, hasKey } from "./api.js";

/** The number of points that are fetched to estimate the size of text. */
const SAMPLE = 2000;
/** The most bytes of an answer to a body: it is held in memory until it is whole. */
export const MOST_HELD = 1e9;

/**
 * The size in bytes of an answer of `count` points, and whether it is exact. `request` gives the
 * request, `limited` the same with a limit.
 * @param {{ path: string, body?: string }} request
 * @param {string} format
 * @param {number} count
 * @param {AbortSignal} [signal]
 */
export async function sizeOf({ path, body }, format, count, signal) {
  if (!body) {
    const head = await ask(path, { method: "HEAD", signal }).catch((error) => error);
    if (head instanceof Error && head.name === "AbortError") throw head;
    // A refusal has words only where there is a body.
    if (head instanceof Error) {
      const answer = await ask(path, { signal });
      await answer.body?.cancel();
    } else if (head.headers.has("content-length") && !head.headers.has("content-encoding")) {
      return { bytes: Number(head.headers.get("content-length")), isExact: true };
    }
  }
  const part = Math.min(SAMPLE, count);
  if (part === 0 || format === "png") return { bytes: NaN, isExact: false };
  const sample = body
    // As text: JSON.parse would round long seeds.
    ? await ask(path, { body: body.replace("{", `{"limit":${part},`), signal })
    : await ask(`${path}&limit=${part}`, { signal });
  const { byteLength } = await sample.arrayBuffer();
  const isExact = part === count || ["f32", "f64"].includes(format);
  return { bytes: Math.round((byteLength * count) / part), isExact };
}

/**
 * Saves an answer under a name; `progress(bytes)` hears how much has come, where that is known.
 * @param {{ path: string, body?: string }} request
 * @param {string} name
 * @param {(bytes: number) => void} progress
 * @param {AbortSignal} [signal]
 */
export async function save({ path, body }, name, progress, signal) {
  // A link cannot carry a key.
  if (!body && !hasKey()) return click(path, name);
  const answer = await ask(path, { body, signal });
  const pieces = [];
  let bytes = 0;
  const reader = /** @type {ReadableStream<Uint8Array>} */ (answer.body).getReader();
  for (;;) {
    const piece = await reader.read().catch((error) => {
      throw error.name === "AbortError" ? error : brokeOff();
    });
    if (piece.done) break;
    pieces.push(piece.value);
    bytes += piece.value.length;
    progress(bytes);
  }
  const url = URL.createObjectURL(new Blob(pieces));
  click(url, name);
  // The browser has taken it by then; keeping it would keep the memory.
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

function click(url, name) {
  const link = document.createElement("a");
  Object.assign(link, { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}
