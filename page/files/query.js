// From the choices on the page to a request: parameters of an address for one layer, a body for several.

import { digits } from "./api.js";
import { encoded } from "./address.js";
import { decimalsFor, formatPlace, moved } from "./place.js";
import { documentOf } from "./sent.js";

/** The attributes that a layer shows, in the order in which they are requested. */
export function attributesOf(layer) {
  return ["angle", "scale", "variant", "rank"].filter((name) => layer[name] || (name === "variant" && layer.spread));
}

/** The names of a layer's variants, in the order in which the server numbers them. */
export function variantNames(layer) {
  return layer.variants.split(",").map((one) => one.split(":")[0].trim()).filter(Boolean).sort();
}

/** The parameters that say what the points of a layer are, as pairs. */
export function setOf(layer, keep = 1) {
  const pairs = [["profile", layer.profile]];
  if (layer.alpha) pairs.push(["alpha", layer.alpha]);
  if (layer.map) pairs.push(["map", layer.map]);
  pairs.push([layer.by, layer.amount.trim()], ["seed", layer.seed.trim()]);
  if (layer.warp !== "") pairs.push(["warp", layer.warp]);
  if (layer.settle !== "") pairs.push(["settle", layer.settle]);
  if (layer.field) pairs.push(["field", layer.field]);
  const share = Math.min(keep, Number(layer.lod) || 1);
  if (share < 1) pairs.push(["lod", String(share)]);
  const attributes = attributesOf(layer);
  if (attributes.length > 0) pairs.push(["attributes", attributes.join(",")]);
  if (layer.scale) pairs.push(["scale_range", layer.range.replace(/\s/g, "")]);
  if (layer.variant || layer.spread) pairs.push(["variants", layer.variants.replace(/\s/g, "")]);
  if (layer.spread && layer.spread !== "chance") pairs.push(["spread", layer.spread]);
  return pairs;
}

/** The world that layers are of, `{ name, seed }`, or nothing. */
export function worldIn(layers) {
  return layers[0].world ?? null;
}

/** The parameters that name a world, and the share of its points, as pairs. */
export function worldPairs({ name, seed }, keep = 1) {
  return [["world", name], ...(seed ? [["seed", seed]] : []), ...(keep < 1 ? [["lod", String(keep)]] : [])];
}

/** Pairs as a query string. */
export function joined(pairs) {
  return pairs.map(([name, value]) => `${name}=${encoded(value)}`).join("&");
}

/**
 * The same as members of a JSON object: numbers as numbers, as far as they are some. A seed above
 * 2⁵³ keeps its digits, as JSON allows and JavaScript does not. With `isWhole`, a field that
 * this page has sent is described in full, so that no server has to hold it.
 */
function memberOf(layer, keep = 1, isWhole = false) {
  const members = {};
  for (const [name, value] of setOf(layer, keep)) {
    if (["spacing", "density", "min_distance", "settle", "lod"].includes(name)) members[name] = numberOr(value);
    else if (name === "warp") members[name] = value === "off" || value === "on" ? value : numberOr(value);
    else if (name === "seed") members[name] = digits(value);
    else if (name === "attributes") members[name] = value.split(",");
    else if (name === "scale_range") members[name] = value.split(",").map(numberOr);
    else if (name === "field") members[name] = (isWhole && documentOf(value)) || value;
    else members[name] = value;
  }
  return members;
}

function numberOr(text) {
  const number = Number(text);
  return text !== "" && Number.isFinite(number) ? number : text;
}

/** The name of a layer in requests, by its index. */
function layerName(i) {
  return `layer${i + 1}`;
}

/** Asks with this body whether layers are right together. */
export function togetherBody(layers) {
  return JSON.stringify(bodyOf(layers, { bbox: [0, 0, 1e-300, 1e-300] }));
}

/** Several layers over a region, as the body of `POST /v1/points:query`. */
function bodyOf(layers, region, keep = 1, looks = {}, isWhole = false) {
  const list = layers.map((layer, i) => {
    /** @type {Record<string, any>} */
    const members = { name: layerName(i), ...memberOf(layer, keep, isWhole) };
    const clear = Number(layer.clear);
    if (i > 0 && clear > 0) {
      members.clear_of = Object.fromEntries(layers.slice(0, i).map((_, j) => [layerName(j), clear]));
    }
    return members;
  });
  return { region, layers: list, ...looks };
}

/**
 * The request for a chunk as packed `f32`: `{ path, body }`, the body only for several layers.
 * @param {import("./state.js").Layer[]} layers
 * @param {import("./chunks.js").Address} address
 * @param {number} keep
 * @returns {{ path: string, body?: string }}
 */
export function chunkRequest(layers, { size, cx, cy }, keep) {
  const world = worldIn(layers);
  if (world) {
    const pairs = worldPairs(world, keep).slice(1);
    return { path: `/v1/worlds/${encodeURIComponent(world.name)}/chunks/${size}/${cx}/${cy}?${joined([...pairs, ["format", "f32"]])}` };
  }
  if (layers.length === 1) {
    const query = joined([...setOf(layers[0], keep), ["format", "f32"]]);
    return { path: `/v1/chunks/${size}/${cx}/${cy}?${query}` };
  }
  const region = { chunk: { size, x: cx, y: cy } };
  return { path: "/v1/points:query", body: JSON.stringify(bodyOf(layers, region, keep, { format: "f32" })) };
}

/**
 * What asks for the points in a box of four decimals, or for their count: the parameters of an address; or a body for several
 * layers, and with `isWhole` for fields that are described in full. `looks` are more parameters, as pairs.
 */
export function askedOf(layers, box, keep, looks = [], isWhole = false) {
  const world = worldIn(layers);
  if (world || (layers.length === 1 && !isWhole)) {
    const pairs = world ? worldPairs(world, keep) : setOf(layers[0], keep);
    return { query: `?${joined([["bbox", box.join(",")], ...pairs, ...looks])}` };
  }
  const region = { bbox: box.map(digits) };
  const form = Object.fromEntries(looks.map(([name, value]) => [name, numberOr(value)]));
  const body = layers.length > 1 ? bodyOf(layers, region, keep, form, isWhole) : { region, ...memberOf(layers[0], keep, isWhole), ...form };
  return { query: "", body: JSON.stringify(body, null, 2) };
}

/** The columns of packed answers besides x and y, as the server joins those of several layers. */
export function columnsOf(layers) {
  if (worldIn(layers)) return layers[0].columns;
  const columns = layers.length > 1 ? ["layer"] : [];
  for (const name of layers.flatMap(attributesOf)) {
    if (!columns.includes(name)) columns.push(name);
  }
  return columns;
}

/** All names of variants, as the server joins those of several layers. */
export function allVariants(layers) {
  return [...new Set(layers.filter((layer) => layer.variant || layer.spread).flatMap(variantNames))];
}

/** The box of a view as four decimal numbers, cut to what can be seen: a sixteenth of a pixel. */
export function boxOf(view) {
  const decimals = decimalsFor(view.unit / 16);
  const [halfX, halfY] = [(view.width * view.unit) / 2, (view.height * view.unit) / 2];
  return [[view.x, -halfX], [view.y, -halfY], [view.x, halfX], [view.y, halfY]]
    .map(([at, by]) => formatPlace(moved(at, by), decimals));
}
