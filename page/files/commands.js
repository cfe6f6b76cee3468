// What returns the points in view: texts to paste elsewhere (the address, curl, Python), and downloads, with their sizes first.

import { ask, hasKey, piecesOf } from "./api.js";
import { make } from "./dom.js";
import { documentOf } from "./sent.js";
import { askedOf } from "./query.js";

/** @typedef {{ path: string, body?: string }} Request */

/** The formats of answers: name, ending of a file, what it is for. A test holds them against the server. */
export const FORMATS = [
  ["csv", "csv", "spreadsheets, pandas"],
  ["json", "json", "programs"],
  ["ndjson", "ndjson", "streams, a point a line"],
  ["geojson", "geojson", "QGIS and other maps"],
  ["geojsonseq", "geojsonl", "maps, as a stream"],
  ["npy", "npy", "numpy"],
  ["arrow", "arrows", "Arrow, Polars, DuckDB"],
  ["ply", "ply", "Blender, MeshLab"],
  ["f64", "f64", "packed doubles"],
  ["f32", "f32", "packed floats, from the lower corner on"],
  ["svg", "svg", "a drawing"],
  ["png", "png", "a picture"],
];

/** A field is written out in a request up to this number of characters: shells take words of 131,071 bytes. */
const MOST_FIELD = 60_000;

/** The parameter that pictures take beside, as pairs. */
export function looksOf(format) {
  return format === "png" || format === "svg" ? [["size", "2048"]] : [];
}

/** The request for the points in a box of four decimals: `{ path }`, with a `body` for layers. */
export function requestOf(layers, box, keep, format) {
  const { query, body } = askedOf(layers, box, keep, [["format", format], ...looksOf(format)], isShort(layers));
  return body ? { path: "/v1/points:query", body } : { path: `/v1/points${query}` };
}

/** Whether the page has sent a field of these layers that a line can hold in full. */
function isShort(layers) {
  const documents = layers.map((layer) => documentOf(layer.field)).filter(Boolean);
  return documents.length > 0 && JSON.stringify(documents).length < MOST_FIELD;
}

/** A word of a shell. */
export function quoted(text) {
  return `'${text.replace(/'/g, "'\\''")}'`;
}

/** The line for curl. */
export function curl(/** @type {string} */ origin, /** @type {{ path: string, body?: string }} */ { path, body }, /** @type {string} */ file) {
  const data = body ? ` \\\n  -d ${quoted(body)}` : "";
  return `curl -f ${quoted(origin + path)} -o ${file}${data}`;
}

/** A program in Python that needs nothing installed, but numpy for its own format. */
export function python(/** @type {string} */ origin, /** @type {Request} */ { path, body }, /** @type {string} */ format, /** @type {string} */ file) {
  const url = JSON.stringify(origin + path);
  const lines = ["from urllib.request import Request, urlopen", ""];
  if (body) lines.push(`query = r"""${body}"""`, `request = Request(${url}, data=query.encode())`);
  else lines.push(`request = Request(${url})`);
  const read = {
    csv: ["import csv, io", ["    points = list(csv.DictReader(io.TextIOWrapper(answer, \"utf-8\")))", "print(len(points), \"points, the first:\", points[:1])"]],
    json: ["import json", ["    points = json.load(answer)[\"points\"]", "print(len(points), \"points, the first:\", points[:1])"]],
    ndjson: ["import json", ["    *points, summary = map(json.loads, answer)", "print(len(points), \"points, the first:\", points[:1])"]],
    npy: ["import io\nimport numpy", ["    points = numpy.load(io.BytesIO(answer.read()))", "print(points.shape, \"the first:\", points[:1])"]],
  }[format];
  if (read) lines.unshift(...read[0].split("\n"));
  else lines.unshift("import shutil");
  lines.push("with urlopen(request) as answer:");
  lines.push(...(read ? read[1] : [`    with open("${file}", "wb") as file:`, "        shutil.copyfileobj(answer, file)"]));
  return lines.join("\n");
}

/** The number of points that are fetched to estimate the size of text. */
const SAMPLE = 2000;
/** The most bytes of an answer to a body: it is held in memory until it is whole. */
export const MOST_HELD = 1e9;

/** The size in bytes of an answer of `count` points, and whether it is exact. */
export async function sizeOf(/** @type {Request} */ { path, body }, /** @type {string} */ format, /** @type {number} */ count, /** @type {AbortSignal=} */ signal) {
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

/** Saves an answer under a name; `progress(bytes)` hears how much has come, where that is known. */
export async function save(/** @type {Request} */ { path, body }, /** @type {string} */ name, /** @type {(bytes: number) => void} */ progress) {
  // A link cannot carry a key.
  if (!body && !hasKey()) return click(path, name);
  const answer = await ask(path, { body });
  const pieces = [];
  let bytes = 0;
  for await (const piece of piecesOf(answer)) {
    pieces.push(piece);
    bytes += piece.length;
    progress(bytes);
  }
  const url = URL.createObjectURL(new Blob(pieces));
  click(url, name);
  // The browser has taken it by then; keeping it would keep the memory.
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

function click(url, name) {
  const link = make("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}
