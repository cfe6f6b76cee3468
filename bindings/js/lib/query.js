// Queries: keywords as the body, and as the address, that REST takes.

import { fault } from "./error.js";
import { KINDS, OUTPUT, REGIONS, WINDOW } from "./parameters.js";
/** @import { Body, Dimension } from "./types.js" */

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

/** @type {(value: unknown) => value is ArrayLike<unknown>} */
export const isList = (value) => Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));
/** @type {(value: unknown) => value is Body} */
export const isObject = (value) => value !== null && typeof value === "object" && !isList(value);

/** @type {(shape: string, value: unknown) => unknown} */
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
            const ring = list.map((vertex) => Array.from(/** @type {ArrayLike<unknown>} */ (vertex ?? [])));
            const [first, last] = [ring[0], ring.at(-1)];
            if (first?.[0] !== last?.[0] || first?.[1] !== last?.[1]) ring.push(first);
            return { type: "Polygon", coordinates: [ring] };
        }
    }
    return value;
}

/** A query, if it is an object. */
export function checked(/** @type {unknown} */ query) {
    if (isObject(query)) return query;
    throw fault("query", String(query), "not an object", "such as { bbox: [0, 0, 10, 10], spacing: 1 }");
}

/** Keywords as a body. Those that are undefined are left out, and regions that are null. */
export function body(/** @type {unknown} */ keywords) {
    /** @type {Body} */
    const made = {};
    for (const [name, value] of Object.entries(checked(keywords))) {
        if (value === undefined || (value === null && KEYWORDS.includes(name))) continue;
        if (KEYWORDS.includes(name)) {
            // Several shapes are refused together, with all their names.
            made.region = Object.assign({}, made.region, { [name]: region(name, value) });
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
export function text(/** @type {unknown} */ value) {
    const plain = (/** @type {string} */ _, /** @type {unknown} */ part) => {
        if (typeof part === "bigint") return `\u0001${part}\u0001`;
        if (typeof part === "number" && !Number.isFinite(part)) return String(part);
        if (typeof part === "function" || typeof part === "symbol") return `[${typeof part}]`;
        return isList(part) ? Array.from(part) : part;
    };
    return JSON.stringify(value, plain).replace(/"\\u0001(-?\d+)\\u0001"/g, "$1");
}

/** The members that hold integers, which are text from 2⁵³ on. */
const LONG = ["seed", "count", "limit", "offset"];

/** A count, typed as a number, as it is below 2⁵³: `any`, since others stay bigints. @type {(count: any) => number} */
export const numberOf = (count) => (count <= Number.MAX_SAFE_INTEGER ? Number(count) : count);

/** JSON as a value. Integers that a number cannot hold exactly are bigints. */
export function parsed(/** @type {string} */ json) {
    const long = (/** @type {unknown} */ of) => (typeof of === "string" && /^\d{16,}$/.test(of) ? BigInt(of) : of);
    return JSON.parse(json, (name, part) => {
        if (name !== "kinds" || !isObject(part)) return LONG.includes(name) ? long(part) : part;
        return Object.fromEntries(Object.entries(part).map(([of, count]) => [of, long(count)]));
    });
}

/** @type {(value: unknown) => string} */
function word(value) {
    if (typeof value === "boolean") return value ? "on" : "off";
    if (isList(value)) return Array.from(value, word).join(",");
    if (isObject(value)) {
        const parts = (/** @type {unknown} */ part) => (isList(part) ? Array.from(part) : [part]).map(word);
        return Object.entries(value).map(([name, part]) => [name, ...parts(part)].join(":")).join(",");
    }
    return String(value);
}

/** Values as the parameters of an address. */
export function address(/** @type {Body} */ values) {
    const there = Object.entries(values).filter(([, value]) => value !== undefined && value !== null);
    return there.map(([name, value]) => `${encodeURIComponent(name)}=${encodeURIComponent(word(value))}`).join("&");
}

/** The integers of an id. */
export function integers(/** @type {string} */ id, /** @type {Dimension} */ dimension) {
    const parts = /^-?\d+(:-?\d+)+$/.test(id) ? id.split(":").map(BigInt) : [];
    if (parts.length === dimension.axes.length) return parts;
    const allowed =
        dimension === SPACE
            ? "three integers joined by colons, such as -31:52:7"
            : "two integers joined by a colon, such as -31:52";
    throw new TypeError(`${JSON.stringify(id)} is no id: ${allowed}`);
}
