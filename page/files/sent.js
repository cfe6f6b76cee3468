// Fields that this page sends: the server holds them while it has room, and the page sends them again when it has not.

import { Problem, askJson, json, onRefused } from "./api.js";

/** The fields that were sent or described by an address, by their digests. */
const held = new Map();
const sending = new Map();

/** The name of a field that was sent: its digest. */
export function isSent(field) {
  return /^[0-9a-f]{64}$/.test(field);
}

/**
 * Sends a field, as JSON describes it. Returns its digest, by which queries name it. `whole` describes the same field
 * without the names of others that were sent; it is sent in turn if the server does not hold those.
 */
export function send(document, whole = document) {
  const body = json(document);
  if (!sending.has(body)) {
    const sent = post(body, json(whole)).then(({ name }) => {
      held.set(name, whole);
      return name;
    });
    sending.set(body, sent.finally(() => sending.delete(body)));
  }
  return sending.get(body);
}

/** Whether a request was refused for a field that the server does not hold. */
function isMissing(error) {
  return error instanceof Problem && (error.status === 404 || /no such field/.test(error.message));
}

/**
 * Posts a field. A refusal is final here: the remedy below posts fields itself, and would wait for itself.
 * @returns {Promise<any>}
 */
async function post(body, whole) {
  try {
    return await askJson("/v1/fields", { body, isAgain: true });
  } catch (error) {
    if (!isMissing(error) || whole === body) throw error;
    return askJson("/v1/fields", { body: whole, isAgain: true });
  }
}

/** The document of a field that this page has sent, or nothing. */
export function documentOf(field) {
  return held.get(field);
}

/** Says what the field of an address is: it is sent if the server turns out not to hold it. */
export function describe(field, document) {
  if (!held.has(field)) held.set(field, document);
}

// A field that the server no longer holds is sent again, and the request is repeated.
onRefused(async (problem, path, body) => {
  if (!isMissing(problem)) return false;
  const named = [...new Set(`${path} ${body ?? ""}`.match(/\b[0-9a-f]{64}\b/g))];
  const known = named.filter((digest) => held.has(digest));
  try {
    await Promise.all(known.map((digest) => send(held.get(digest))));
  } catch {
    // The refusal of the request says more than that of the field.
    return false;
  }
  return known.length > 0;
});
