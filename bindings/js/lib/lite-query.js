// The queries of strew/lite: the members of REST's JSON that it knows, checked, as numbers for its module.

import { fault, invalid } from "./error.js";
import { text } from "./query.js";

const MOST = 2n ** 64n - 1n;
const AMOUNTS = ["spacing", "density", "min_distance"];
const CELL = 2 ** 52;

/** Why a value is not valid. */
class Wrong {
    constructor(detail) {
        this.detail = detail;
    }
}

const OUT_OF_RANGE = new Wrong("out of range");
const number = (least, most, shown = most) => ({
    allowed: `a number from ${least} to ${shown}`,
    read: (value) => {
        if (typeof value !== "number" || Number.isNaN(value)) return new Wrong("must be a number");
        return value >= least && value <= most ? value : OUT_OF_RANGE;
    },
});
const integer = (least, most) => ({
    allowed: `an integer from ${least} to ${most}`,
    read: (value) => {
        const isText = typeof value === "string" && /^-?\d+$/.test(value);
        const isWhole = typeof value === "bigint" || Number.isInteger(value) || isText;
        if (!isWhole) return new Wrong("must be an integer");
        return BigInt(value) >= BigInt(least) && BigInt(value) <= BigInt(most) ? BigInt(value) : OUT_OF_RANGE;
    },
});
const numbers = (count, allowed, test = () => true) => ({
    allowed,
    read: (value) => {
        if (!value || typeof value !== "object" || !("length" in value)) return new Wrong(`must be ${count} numbers`);
        const list = Array.from(value);
        if (list.length !== count) return new Wrong(`expected ${count} numbers, got ${list.length}`);
        const odd = list.find((part) => typeof part !== "number" || !Number.isFinite(part));
        if (odd !== undefined || list.includes(undefined)) return new Wrong(`\`${odd}\` is not a finite number`);
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
        read: (value) => ({ off: 0, on: 1 })[value] ?? number(0, 2).read(value),
    },
    keep: number(1e-6, 1),
    settle: integer(0, 4),
    lod: number(1e-6, 1),
    attributes: {
        allowed: "angle, scale, variant, rank, u1 to u16",
        read: (value) => {
            const list = typeof value === "string" ? value.split(",").map((name) => name.trim()) : value;
            const isKnown = (name) => /^(angle|scale|variant|rank|u([1-9]|1[0-6]))$/.test(name);
            if (!Array.isArray(list)) return new Wrong("must be names");
            const odd = list.find((name) => !isKnown(name));
            return odd === undefined ? list : new Wrong(`unknown attribute \`${odd}\``);
        },
    },
    scale_range: numbers(
        2,
        "two numbers min,max with 0 <= min <= max <= 1e9",
        ([min, max]) => 0 <= min && min <= max && max <= 1e9,
    ),
    variants: {
        allowed: "names with their weights, numbers from 1e-9 to 1e9",
        read: (value) => {
            if (!value || typeof value !== "object" || Array.isArray(value)) return new Wrong("must be an object");
            const entries = Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1));
            const odd = entries.find(([, weight]) => number(1e-9, 1e9).read(weight) instanceof Wrong);
            return odd ? new Wrong(`the weight of ${odd[0]} is not valid`) : entries;
        },
    },
};
/** The table of queries that name none, the same everywhere. */
const USUAL = { profile: "blue", alpha: "(5-sqrt(3))/2", map: "m" };

/** The parameters that name the open table, and those that a query must have so that it means this one. */
export function naming(table) {
    const odd = Object.keys(USUAL).filter((name) => table[name] !== USUAL[name]);
    const named = ([name, own]) => {
        const allowed = `${name}: "${own}", or open({ table }) with another file, as of the package strew-tables`;
        const read = (value) => (String(value) === own ? own : new Wrong("is not that of the open table"));
        return [name, { allowed, read }];
    };
    const known = Object.fromEntries(Object.entries(table).map(named));
    return { known: { ...KNOWN, ...known }, needed: odd.length ? new Set([...odd, "map"]) : new Set() };
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
    #all = [];

    add(field, value, detail, allowed) {
        this.#all.push({ field, value: value === undefined ? null : text(value), detail, allowed });
    }

    read(field, value, { allowed, read }) {
        const valid = read(value);
        if (!(valid instanceof Wrong)) return valid;
        this.add(field, value, valid.detail, allowed);
        return undefined;
    }

    check() {
        if (this.#all.length) throw invalid(this.#all);
    }
}

/** A region as a call of the module with its numbers. */
function area(region, faults) {
    const [shape, ...more] = Object.keys(region ?? {});
    const value = region?.[shape];
    const field = `region.${shape}`;
    if (!more.length && shape === "bbox") {
        const values = faults.read(field, value, BBOX) ?? [];
        return { call: "within_box", values, reach: Math.max(...values.map(Math.abs)) };
    }
    if (!more.length && shape === "circle") {
        const list = value?.center ? [...value.center, value.radius] : value;
        const values = faults.read(field, list, CIRCLE) ?? [];
        const [x, y, radius] = values;
        return { call: "within_circle", values, reach: Math.max(Math.abs(x), Math.abs(y)) + radius };
    }
    if (!more.length && shape === "chunk") {
        const list = value && "size" in value ? [value.size, value.x, value.y] : value;
        const [size, x, y] = faults.read(field, list, CHUNK) ?? [1, 0, 0];
        return { call: "chunk", values: [size, BigInt(x), BigInt(y)], reach: size };
    }
    faults.add("region", region, "is not in strew/lite", "one of bbox, chunk, circle");
    return undefined;
}

/** A checked query: the numbers of its set, which have a `key`, its region, and the place of a search. */
export function read({ region, ...members }, { known: all, needed }, search = {}) {
    const [faults, is] = [new Faults(), {}];
    for (const [values, known] of [[members, all], [search, SEARCH]]) {
        for (const [name, value] of Object.entries(values)) {
            if (value === undefined && name !== "at") continue;
            if (Object.hasOwn(known, name)) is[name] = faults.read(name, value, known[name]);
            else faults.add(name, value, "no such parameter in strew/lite", Object.keys(known).join(", "));
        }
    }
    for (const name of needed) {
        const usual = `is missing: without it the query means the table of ${name} ${USUAL[name]}, which is not open`;
        if (members[name] === undefined) faults.add(name, undefined, usual, all[name].allowed);
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
    for (const [needed, name] of [["variants", "variant"], ["scale_range", "scale"]]) {
        if (is[needed] && !attributes.includes(name)) {
            faults.add(needed, members[needed], `is not used`, `beside the attribute ${name}`);
        }
    }
    const place = region === undefined ? undefined : area(region, faults);
    faults.check();
    const { seed = 0n, warp = NaN, keep = 1, settle = -1, lod = 1, scale_range: range = [0, 1] } = is;
    const [amount] = amounts;
    const set = [AMOUNTS.indexOf(amount), is[amount], BigInt.asIntN(64, seed), warp, keep, Number(settle), lod];
    const key = text([set.map(String), attributes, range, variants]);
    const k = is.k === undefined ? undefined : Number(is.k);
    const least = is.min_distance;
    const [own, where] = [{ amount, attributes, least, key, numbers: set, range, variants }, { at: is.at, k, radius: is.radius }];
    return { ...own, ...where, region: place };
}

// f64 coordinates keep a least distance out to this many times it (strew-core's LeastDistance::RANGE).
const RANGE = 2 ** 30;

/** Refuses a least distance that coordinates within ±`reach` do not keep. */
export function checkReach(distance, reach) {
    if (distance === undefined || reach <= RANGE * distance) return;
    const near = RANGE * distance;
    const detail = `coordinates up to ${reach} are rounded too coarsely to keep it: it holds within ±${near}`;
    const allowed = `coordinates within ±${near}, a distance of at least ${reach / RANGE}, chunks, or spacing`;
    throw fault("min_distance", text(distance), detail, allowed);
}
