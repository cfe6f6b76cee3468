// Fields that this page sends: the server holds them while it has room, and the page sends them again when it has not.

import { askJson, onRefused } from "./api.js";

/** What was sent, by its digest. */
const held = new Map();
/** What an address describes: sent if the server turns out not to hold it. */
const expected = [];
let catchingUp = Promise.resolve();
const sending = new Map();

/** The name of a field that was sent: its digest. */
export function isSent(field) {
  return /^[0-9a-f]{64}$/.test(field);
}

/**
 * Sends a field, as JSON describes it. Returns its digest, by which queries name it. `whole` describes the same field
 * without the names of others that were sent.
 */
export function send(document, whole = document) {
  const body = JSON.stringify(document);
  if (!sending.has(body)) {
    const sent = askJson("/v1/fields", { body }).then(({ name }) => {
      held.set(name, whole);
      return name;
    });
    sending.set(body, sent.finally(() => sending.delete(body)));
  }
  return sending.get(body);
}

/** What a field is that this page has sent, or nothing. */
export function documentOf(field) {
  return held.get(field);
}

/** Says what the field of an address is; it may be needed later. */
export function expect(document) {
  expected.push(document);
}

// A field that the server no longer holds is sent again, and the request is repeated.
onRefused(async (problem, path, body) => {
  if (problem.status !== 404 && !/no such field/.test(problem.message)) return false;
  const named = [...new Set(`${path} ${body ?? ""}`.match(/\b[0-9a-f]{64}\b/g))];
  if (named.some((digest) => !held.has(digest))) {
    // Several requests are refused at once: all of them wait for the same.
    const all = [catchingUp, ...expected.splice(0).map((document) => send(document))];
    catchingUp = Promise.all(all).catch(() => {});
    await catchingUp;
  }
  const known = named.filter((digest) => held.has(digest));
  await Promise.all(known.map((digest) => send(held.get(digest))));
  return known.length > 0;
});
