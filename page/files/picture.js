// A picture that becomes dots: it is sent once, and then named by its digest, chunk by chunk.

import { contextOf } from "./dom.js";
import { toNumber } from "./place.js";
import { send } from "./sent.js";

/** The server takes a million pixels at most. */
const MOST_PIXELS = 1_000_000;
/** The number of dots, about, of a picture that is dark all over. */
const DOTS = 60_000;

/**
 * Sends a picture, laid over the middle of a view. Returns what the layer becomes: its field, how many points,
 * and what they look like.
 */
export async function sendPicture(file, view) {
  const { png, width, height } = await encoded(file);
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
async function encoded(file) {
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
