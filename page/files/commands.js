// Texts to paste elsewhere that return the points in view: the address, curl, Python.

import { documentOf } from "./sent.js";
import { askedOf } from "./query.js";

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

/**
 * A program in Python that needs nothing installed, but numpy for its own format.
 * @param {string} origin
 * @param {{ path: string, body?: string }} request
 * @param {string} format
 * @param {string} file
 */
export function python(origin, { path, body }, format, file) {
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
