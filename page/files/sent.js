// Fields that this page sends, pictures that become dots among them: the server holds them while it has room, and the page sends
// them again when it has not.

import { Problem, askJson, onRefused } from "./api.js";
import { contextOf } from "./dom.js";
import { toNumber } from "./place.js";

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
  const body = JSON.stringify(document);
  if (!sending.has(body)) {
    const sent = post(body, JSON.stringify(whole)).then(({ name }) => {
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

/** The server takes a million pixels at most. */
const MOST_PIXELS = 1_000_000;
/** The number of dots, about, of a picture that is dark all over. */
const DOTS = 60_000;

/**
 * Sends a picture, laid over the middle of a view. Returns what the layer becomes: its field, how many points,
 * and what they look like.
 */
export async function sendPicture(file, view) {
  const { png, width, height } = await encodedPicture(file);
  const across = Math.min((view.width * view.unit) / width, (view.height * view.unit) / height) * 0.9;
  const [x, y] = [toNumber(view.x), toNumber(view.y)];
  const [halfX, halfY] = [(width * across) / 2, (height * across) / 2];
  const bbox = [x - halfX, y - halfY, x + halfX, y + halfY];
  // Dark where the picture is dark, on white paper.
  const document = { raster: { png, bbox, low: 1, high: 0 } };
  const field = await send(document);
  const spacing = Math.sqrt((4 * halfX * halfY) / DOTS);
  return { field, paint: "", by: "spacing", amount: String(Number(spacing.toPrecision(4))), dot: 1.2, paper: true, shade: false };
}

/** The picture as a PNG in base64, smaller if it is too large. */
async function encodedPicture(file) {
  let picture;
  try {
    picture = await createImageBitmap(file);
  } catch {
    throw new Error(`This browser cannot read “${file.name}”.`);
  }
  const scale = Math.min(1, Math.sqrt(MOST_PIXELS / (picture.width * picture.height)));
  const [width, height] = [picture.width, picture.height].map((side) => Math.max(1, Math.floor(side * scale)));
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  const context = contextOf(canvas);
  context.fillStyle = "#fff";
  context.fillRect(0, 0, width, height);
  context.drawImage(picture, 0, 0, width, height);
  const png = canvas.toDataURL("image/png").split(",")[1];
  return { png, width, height };
}

/** Takes pictures that are dropped on an element. */
export function takeDrops(element, taken) {
  const hasFile = (event) => [...(event.dataTransfer?.items ?? [])].some((item) => item.kind === "file");
  element.addEventListener("dragover", (event) => {
    if (hasFile(event)) event.preventDefault();
  });
  element.addEventListener("drop", (event) => {
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    event.preventDefault();
    taken(file);
  });
}
