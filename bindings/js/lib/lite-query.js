// The queries of strew/lite: the members of REST's JSON that it knows, checked, as numbers for its module.

import { fault, invalid } from "./error.js";
import { isList, isObject, text } from "./query.js";
/** @import { Fault } from "./index.js" */
/** @import { Body, LiteArea } from "./types.js" */

const MOST = 2n ** 64n - 1n;
/** @type {("spacing" | "density" | "min_distance")[]} */
const AMOUNTS = ["spacing", "density", "min_distance"];
const CELL = 2 ** 52;

/** Why a value is not valid. */
class Wrong {
    constructor(/** @type {string} */ detail) {
        this.detail = detail;
    }
}

const OUT_OF_RANGE = new Wrong("out of range");
/** @typedef {{ call: LiteArea, values: (number | bigint)[], reach: number }} Area */
/** @template Valid @typedef {{ allowed: string, read: (value: unknown) => Valid | Wrong }} Rule */

/** @type {(least: number, most: number, shown?: number | string) => Rule<number>} */
const number = (least, most, shown = most) => ({
    allowed: `a number from ${least} to ${shown}`,
    read: (value) => {
        if (typeof value !== "number" || Number.isNaN(value)) return new Wrong("must be a number");
        return value >= least && value <= most ? value : OUT_OF_RANGE;
    },
});
/** @type {(least: number, most: number | bigint) => Rule<bigint>} */
const integer = (least, most) => ({
    allowed: `an integer from ${least} to ${most}`,
    read: (value) => {
        const isText = typeof value === "string" && /^-?\d+$/.test(value);
        const isWhole = typeof value === "bigint" || Number.isInteger(value) || isText;
        if (!isWhole) return new Wrong("must be an integer");
        const whole = BigInt(/** @type {string | number | bigint} */ (value));
        return whole >= least && whole <= most ? whole : OUT_OF_RANGE;
    },
});
/** @type {(count: number, allowed: string, test?: (list: number[]) => boolean) => Rule<number[]>} */
const numbers = (count, allowed, test = () => true) => ({
    allowed,
    read: (value) => {
        if (!value || typeof value !== "object" || !("length" in value)) return new Wrong(`must be ${count} numbers`);
        const list = Array.from(/** @type {ArrayLike<number>} */ (value));
        if (list.length !== count) return new Wrong(`expected ${count} numbers, got ${list.length}`);
        const odd = list.findIndex((part) => !Number.isFinite(part));
        if (odd >= 0) return new Wrong(`\`${list[odd]}\` is not a finite number`);
        return test(list) ? list : OUT_OF_RANGE;
    },
});

const KNOWN = {
    spacing: number(1e-100, 1e100, "1e100"),
    density: number(1e-200, 1e200, "1e200"),
    min_distance: number(1e-100, 1e100, "1e100"),
    seed: integer(0, MOST),
    warp: {
        allowed: "off, on, or a number from 0 to 2",
        read: (/** @type {unknown} */ value) => number(0, 2).read(value === "off" ? 0 : value === "on" ? 1 : value),
    },
    keep: number(1e-6, 1),
    settle: integer(0, 4),
    lod: number(1e-6, 1),
    attributes: {
        allowed: "angle, scale, variant, rank, u1 to u16",
        read: (/** @type {unknown} */ value) => {
            const list = typeof value === "string" ? value.split(",").map((name) => name.trim()) : value;
            if (!Array.isArray(list)) return new Wrong("must be names");
            const odd = list.findIndex((name) => !/^(angle|scale|variant|rank|u([1-9]|1[0-6]))$/.test(name));
            return odd < 0 ? list : new Wrong(`unknown attribute \`${list[odd]}\``);
        },
    },
    scale_range: numbers(2, "two numbers min,max with 0 <= min <= max <= 1e9", ([min, max]) => {
        return 0 <= min && min <= max && max <= 1e9;
    }),
    variants: {
        allowed: "names with their weights, numbers from 1e-9 to 1e9",
        read: (/** @type {unknown} */ value) => {
            if (!isObject(value)) return new Wrong("must be an object");
            const weights = /** @type {Record<string, number>} */ (value);
            const entries = Object.entries(weights).sort(([a], [b]) => (a < b ? -1 : 1));
            const odd = entries.find(([, weight]) => number(1e-9, 1e9).read(weight) instanceof Wrong);
            return odd ? new Wrong(`the weight of ${odd[0]} is not valid`) : entries;
        },
    },
};
/** The table of queries that name none, the same everywhere. @type {Record<string, string>} */
const USUAL = { profile: "blue", alpha: "(5-sqrt(3))/2", map: "m" };

/** The parameters that name the open table, and those that a query must have so that it means this one. */
export function naming(/** @type {Record<string, string>} */ table) {
    const odd = Object.keys(USUAL).filter((name) => table[name] !== USUAL[name]);
    /** @type {Record<string, Rule<unknown>>} */
    const known = { ...KNOWN };
    for (const [name, own] of Object.entries(table)) {
        const allowed = `${name}: "${own}", or open({ table }) with another file, as of the package strew-tables`;
        const wrong = new Wrong("is not that of the open table");
        known[name] = { allowed, read: (value) => (String(value) === own ? own : wrong) };
    }
    return { known, needed: new Set(odd.length ? [...odd, "map"] : []) };
}

const SEARCH = {
    at: numbers(2, "two finite numbers x,y"),
    k: integer(1, 10000),
    radius: number(0, Number.MAX_VALUE),
};

const BBOX = numbers(
    4,
    "four finite numbers min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y",
    ([x0, y0, x1, y1]) => x0 < x1 && y0 < y1,
);
const CIRCLE = numbers(3, "three finite numbers x,y,radius with a radius above 0", ([, , radius]) => radius > 0);
const CHUNK = numbers(
    3,
    `a size above 0 and two integers within ±${CELL}, the chunk's column and row`,
    ([size, ...cell]) => size > 0 && cell.every((k) => Number.isInteger(k) && Math.abs(k) <= CELL),
);

/** What is wrong with a query: all of it. */
class Faults {
    /** @type {Fault[]} */
    #all = [];

    /** @type {(field: string, value: unknown, detail: string, allowed: string) => void} */
    add(field, value, detail, allowed) {
        this.#all.push({ field, value: value === undefined ? null : text(value), detail, allowed });
    }

    /** @type {<Valid>(field: string, value: unknown, rule: Rule<Valid>) => Valid | undefined} */
    read(field, value, { allowed, read }) {
        const valid = read(value);
        if (!(valid instanceof Wrong)) return valid;
        this.add(field, value, valid.detail, allowed);
    }

    check() {
        if (this.#all.length) throw invalid(this.#all);
    }
}

/** A region as a call of the module with its numbers. @type {(region: unknown, faults: Faults) => Area | undefined} */
function area(region, faults) {
    const [[shape, value] = [], ...more] = isObject(region) ? Object.entries(region) : [];
    const field = `region.${shape}`;
    if (!more.length && shape === "bbox") {
        const values = faults.read(field, value, BBOX) ?? [];
        return { call: "within_box", values, reach: Math.max(...values.map(Math.abs)) };
    }
    if (!more.length && shape === "circle") {
        const list = isObject(value) && isList(value.center) ? [...Array.from(value.center), value.radius] : value;
        const values = faults.read(field, list, CIRCLE) ?? [];
        const [x, y, radius] = values;
        return { call: "within_circle", values, reach: Math.max(Math.abs(x), Math.abs(y)) + radius };
    }
    if (!more.length && shape === "chunk") {
        const list = isObject(value) && "size" in value ? [value.size, value.x, value.y] : value;
        const [size, x, y] = faults.read(field, list, CHUNK) ?? [1, 0, 0];
        return { call: "chunk", values: [size, BigInt(x), BigInt(y)], reach: size };
    }
    faults.add("region", region, "is not in strew/lite", "one of bbox, chunk, circle");
}

/** @typedef {typeof KNOWN & typeof SEARCH} Rules */
/** @typedef {{ [Name in keyof Rules]?: Rules[Name] extends Rule<infer Valid> ? Valid : never }} Valid */

/**
 * A checked query: the numbers of its set, which have a `key`, its region, and the place of a search.
 * @param {Body} query @param {ReturnType<typeof naming>} names @param {Body} search
 */
export function read({ region, ...members }, { known, needed }, search = {}) {
    const faults = new Faults();
    /** @type {Valid} */
    const is = {};
    const check = (/** @type {Body} */ values, /** @type {typeof known} */ rules) => {
        for (const [name, value] of Object.entries(values)) {
            if (value === undefined && name !== "at") continue;
            if (Object.hasOwn(rules, name)) Object.assign(is, { [name]: faults.read(name, value, rules[name]) });
            else faults.add(name, value, "no such parameter in strew/lite", Object.keys(rules).join(", "));
        }
    };
    check(members, known);
    check(search, SEARCH);
    for (const name of needed) {
        const usual = `is missing: without it the query means the table of ${name} ${USUAL[name]}, which is not open`;
        if (members[name] === undefined) faults.add(name, undefined, usual, known[name].allowed);
    }
    const amounts = AMOUNTS.filter((name) => members[name] !== undefined);
    if (amounts.length !== 1) {
        const detail = amounts.length ? "only one of them" : "is missing";
        faults.add(amounts.join() || "spacing", undefined, detail, AMOUNTS.join(", "));
    }
    const { attributes = [], variants = [] } = is;
    if (attributes.includes("variant") && !variants.length) {
        faults.add("variants", undefined, "is missing", KNOWN.variants.allowed);
    }
    for (const [needed, name] of /** @type {const} */ ([["variants", "variant"], ["scale_range", "scale"]])) {
        if (is[needed] && !attributes.includes(name)) {
            faults.add(needed, members[needed], `is not used`, `beside the attribute ${name}`);
        }
    }
    const place = region === undefined ? undefined : area(region, faults);
    faults.check();
    const { seed = 0n, warp = NaN, keep = 1, settle = -1, lod = 1, scale_range: range = [0, 1] } = is;
    const [amount] = amounts;
    const size = /** @type {number} */ (is[amount]);
    const set = [AMOUNTS.indexOf(amount), size, BigInt.asIntN(64, seed), warp, keep, Number(settle), lod];
    const key = text([set.map(String), attributes, range, variants]);
    const k = is.k === undefined ? undefined : Number(is.k);
    const { at, radius, min_distance: least } = is;
    return { amount, attributes, least, key, numbers: set, range, variants, at, k, radius, region: place };
}

// f64 coordinates keep a least distance out to this many times it (strew-core's LeastDistance::RANGE).
const RANGE = 2 ** 30;

/** Refuses a least distance that coordinates within ±`reach` do not keep. */
export function checkReach(/** @type {number | undefined} */ distance, /** @type {number} */ reach) {
    if (distance === undefined || reach <= RANGE * distance) return;
    const near = RANGE * distance;
    const detail = `coordinates up to ${reach} are rounded too coarsely to keep it: it holds within ±${near}`;
    const allowed = `coordinates within ±${near}, a distance of at least ${reach / RANGE}, chunks, or spacing`;
    throw fault("min_distance", text(distance), detail, allowed);
}
