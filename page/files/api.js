// Asking the server: errors in its own words, and patience while it is away.

/**
 * What the server has against a value.
 * @typedef {{ field: string, value?: string, detail: string, allowed?: string }} Fault
 */

/** A refusal of the server, in its words. */
export class Problem extends Error {
  /** `retryAfter` is in seconds. */
  constructor(/** @type {number} */ status, /** @type {string} */ words, retryAfter = 0, /** @type {Fault[]} */ faults = []) {
    super(words);
    this.status = status;
    this.retryAfter = retryAfter;
    this.faults = faults;
  }

  /** Whether a key is needed, or another one. */
  get isLocked() {
    return this.status === 401;
  }

  /** Whether the same request may well be answered a little later. */
  get isPassing() {
    return this.status === 429 || this.status === 503;
  }
}

/** The server cannot be reached, or went away in the middle. */
export class Gone extends Error {}

/** Whether an error is that of a request which this page gave up. */
export function isAborted(error) {
  return error instanceof DOMException && error.name === "AbortError";
}

/** What an error says. */
export function wordsOf(error) {
  return error instanceof Error ? error.message : String(error);
}

const KEY = "strew-key";

/** Keeps a key for as long as this tab is open. */
export function useKey(/** @type {string} */ key) {
  sessionStorage.setItem(KEY, key);
}

/** Whether there is a key to ask with. */
export function hasKey() {
  return Boolean(sessionStorage.getItem(KEY));
}

/** The headers of a request: its key, and the type of a body of JSON. */
export function headersFor(/** @type {BodyInit=} */ body) {
  /** @type {Record<string, string>} */
  const headers = body === undefined ? {} : { "content-type": "application/json" };
  if (hasKey()) headers.authorization = `Bearer ${sessionStorage.getItem(KEY)}`;
  return headers;
}

/** @typedef {(isGone: boolean) => void} Presence */
/** @type {Set<Presence>} */
const listeners = new Set();
let isGone = false;

/** Calls a function whenever the server goes or comes back. Returns what ends that. */
export function onPresence(/** @type {Presence} */ listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Whether the server is away, as far as we know. */
export function isAway() {
  return isGone;
}

/** @param {boolean} gone */
function presence(gone) {
  if (gone === isGone) return;
  isGone = gone;
  for (const listener of listeners) listener(gone);
  if (gone) look(500);
}

/** Looks whether the server is back, ever more rarely: after ½, 1, 2, 4 and then every 8 seconds; `wait` is in milliseconds. */
function look(/** @type {number} */ wait) {
  setTimeout(async () => {
    try {
      const answer = await fetch("/livez", { cache: "no-store" });
      if (answer.ok) return presence(false);
    } catch { /* Not yet. */ }
    look(Math.min(8000, wait * 2));
  }, wait);
}

/** The pieces of the body of an answer, as they come. One that breaks off says that the server is away. */
export const piecesOf = async function* (/** @type {Response} */ answer) {
  const reader = /** @type {ReadableStream<Uint8Array>} */ (answer.body).getReader();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      if (done) return;
      yield value;
    }
  } catch (error) {
    throw isAborted(error) ? error : brokeOff();
  } finally {
    reader.cancel().catch(() => {});
  }
};

/** Says that a body broke off: the server went away while it was sending. */
export function brokeOff() {
  presence(true);
  return new Gone("the connection broke off");
}

/** @typedef {(problem: Problem, path: string, body?: BodyInit) => Promise<boolean>} Mend */
/** @type {Mend} */
let remedy = async () => false;

/** Has a function called where the server refuses a request; if it says true, the request is repeated. */
export function onRefused(/** @type {Mend} */ mend) {
  remedy = mend;
}

/** @typedef {{ body?: BodyInit, signal?: AbortSignal, method?: string, isAgain?: boolean }} Options */

/**
 * The answer to a request; a body makes it a `POST`.
 *
 * Throws `Problem` for what the server refuses, `Gone` if it is not there, and an `AbortError` where
 * `signal` says so.
 * @param {string} path
 * @param {Options} options
 * @returns {Promise<Response>}
 */
export async function ask(path, { body, signal, method, isAgain } = {}) {
  let answer;
  try {
    answer = await fetch(path, {
      method: method ?? (body === undefined ? "GET" : "POST"),
      headers: headersFor(body),
      body,
      signal,
    });
  } catch (error) {
    if (isAborted(error)) throw error;
    presence(true);
    throw new Gone("the server does not answer");
  }
  if (answer.ok) return answer;
  const problem = await answer.json().catch(() => ({}));
  const words = problem.detail ?? problem.title ?? `the server answered ${answer.status} ${answer.statusText}`.trim();
  const refused = new Problem(answer.status, words, Number(answer.headers.get("retry-after")) || 0, problem.errors);
  if (!isAgain && await remedy(refused, path, body)) return ask(path, { body, signal, method, isAgain: true });
  throw refused;
}

/**
 * A JSON document.
 * @template {string} Path
 * @param {Path} path
 * @param {Options} [options]
 * @returns {Promise<Path extends `${infer Bare}?${string}` ? Answer<Bare> : Answer<Path>>}
 */
export async function askJson(path, options) {
  const answer = await ask(path, options);
  try {
    return await answer.json();
  } catch (error) {
    if (isAborted(error)) throw error;
    throw brokeOff();
  }
}

/** A number that JSON has as it was typed, with all of its digits where the browser can; what is no number is text. */
export function digits(/** @type {string} */ text) {
  if (!/^-?\d+(\.\d+)?(e[+-]?\d+)?$/i.test(text)) return text;
  return JSON.rawJSON?.(text.replace(/^(-?)0+(?=\d)/, "$1")) ?? Number(text);
}
