// Queries: keywords as the body, and as the address, that REST takes.

import { fault } from "./error.js";
import { KINDS, OUTPUT, REGIONS, WINDOW } from "./parameters.js";

// Regions that are keywords: of the plane, and of space.
export const SHAPES = [...REGIONS, "chunk"];
export const VOLUMES = ["bbox", "ball", "prism", "chunk"];
const KEYWORDS = [...new Set([...SHAPES, ...VOLUMES])];

/** The plane: the coordinates of points, their regions, and the paths of REST. */
export const PLANE = { axes: "xy", shapes: SHAPES, root: "/v1", queries: "/v1/points:query" };
/** Space. */
export const SPACE = { axes: "xyz", shapes: VOLUMES, root: "/v1/space", queries: "/v1/space/points" };

// Members of a query that are not about its set of points.
export const OF_ANSWERS = ["region", ...WINDOW, ...OUTPUT];

const isList = (value) => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));
export const isObject = (value) => value !== null && typeof value === "object" && !isList(value);

function region(shape, value) {
    // Other values are passed on unchanged, to be refused in the words of REST.
    if (isList(value)) {
        const list = Array.from(value);
        if (shape === "circle" && list.length === 3) return { center: [list[0], list[1]], radius: list[2] };
        if (shape === "ball" && list.length === 4) return { center: list.slice(0, 3), radius: list[3] };
        if (shape === "chunk" && list.length === 3) return { size: list[0], x: list[1], y: list[2] };
        if (shape === "chunk" && list.length === 4) return { size: list[0], x: list[1], y: list[2], z: list[3] };
        if (shape === "prism" && list.length === 3) {
            return { polygon: region("polygon", list[0]), bottom: list[1], top: list[2] };
        }
        if (shape === "polygon") {
            const ring = list.map((vertex) => Array.from(vertex));
            const [first, last] = [ring[0], ring.at(-1)];
            if (first && (first[0] !== last[0] || first[1] !== last[1])) ring.push(first);
            return { type: "Polygon", coordinates: [ring] };
        }
    }
    return value;
}

/** A query, if it is an object. */
export function checked(query) {
    if (isObject(query)) return query;
    throw fault("query", String(query), "not an object", "such as { bbox: [0, 0, 10, 10], spacing: 1 }");
}

/** Keywords as a body. Those that are undefined are left out, and regions that are null. */
export function body(keywords) {
    const made = {};
    for (const [name, value] of Object.entries(checked(keywords))) {
        if (value === undefined || (value === null && KEYWORDS.includes(name))) continue;
        if (KEYWORDS.includes(name)) {
            // Several shapes are refused together, with all their names.
            made.region = { ...made.region, [name]: region(name, value) };
        } else if (KINDS[name] === "names" && typeof value === "string") {
            made[name] = value.split(",").map((word) => word.trim());
        } else {
            made[name] = value;
        }
    }
    return made;
}

/**
 * A body as JSON: a bigint is an integer, a typed array a list. Values that JSON cannot hold (NaN, infinity, functions,
 * symbols) become words, so that they are refused with the name of their member and the values allowed there.
 */
export function text(value) {
    const plain = (_, part) => {
        if (typeof part === "bigint") return `\u0001${part}\u0001`;
        if (typeof part === "number" && !Number.isFinite(part)) return String(part);
        if (typeof part === "function" || typeof part === "symbol") return `[${typeof part}]`;
        return isList(part) ? Array.from(part) : part;
    };
    return JSON.stringify(value, plain).replace(/"\\u0001(-?\d+)\\u0001"/g, "$1");
}

/** The members that hold integers, which are text from 2⁵³ on. */
const LONG = ["seed", "count", "limit", "offset"];

/** JSON as a value. Integers that a number cannot hold exactly are bigints. */
export function parsed(json) {
    const long = (part) => (typeof part === "string" && /^\d{16,}$/.test(part) ? BigInt(part) : part);
    return JSON.parse(json, (name, part) => {
        if (name !== "kinds" || typeof part !== "object") return LONG.includes(name) ? long(part) : part;
        return Array.isArray(part) ? part : Object.fromEntries(Object.entries(part).map(([of, count]) => [of, long(count)]));
    });
}

function word(value) {
    if (typeof value === "boolean") return value ? "on" : "off";
    if (isList(value)) return Array.from(value, word).join(",");
    if (isObject(value)) {
        const pair = ([name, part]) => [name, ...(isList(part) ? Array.from(part) : [part]).map(word)].join(":");
        return Object.entries(value).map(pair).join(",");
    }
    return String(value);
}

/** Values as the parameters of an address. */
export function address(values) {
    const there = Object.entries(values).filter(([, value]) => value !== undefined && value !== null);
    return there.map(([name, value]) => `${encodeURIComponent(name)}=${encodeURIComponent(word(value))}`).join("&");
}

/** The integers of an id. */
export function integers(id, dimension) {
    const parts = /^-?\d+(:-?\d+)+$/.test(id) ? id.split(":").map(BigInt) : [];
    if (parts.length === dimension.axes.length) return parts;
    const allowed =
        dimension === SPACE
            ? "three integers joined by colons, such as -31:52:7"
            : "two integers joined by a colon, such as -31:52";
    throw new TypeError(`${JSON.stringify(id)} is no id: ${allowed}`);
}
