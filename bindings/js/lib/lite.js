// Points of one table, by a small module: the core of Strew without its queries, formats and fields.

import { StrewError, fault } from "./error.js";
import { compile, content } from "./files.js";
import { HeldPlan } from "./held.js";
import { LiteModule } from "./lite-module.js";
import { checkReach, naming, read } from "./lite-query.js";
import { PointSet, rowsOf } from "./points.js";
import { PLANE, body, integers, numberOf } from "./query.js";
/** @import { Backend, Body, Content, Further, Kind, LiteOutput, LiteSet, OpenLite, Plan } from "./types.js" */

export { StrewError } from "./error.js";
export { PointSet } from "./points.js";

/** Sets that are kept, with their attributes: those that were used last. */
const KEPT = 16;
/** The most points of an answer, as a daemon's by default. */
const MOST_POINTS = 100_000_000n;
const none = (/** @type {string} */ what) => {
    throw new StrewError(`strew/lite has no ${what}: import "strew"`, "unsupported");
};

/** This page or process, with one table. @implements {Backend<"here">} */
class Lite {
    side = /** @type {const} */ ("here");
    #module;
    #table;
    #naming;
    /** @type {Map<string, LiteSet>} */
    #sets = new Map();

    constructor(/** @type {LiteModule} */ module) {
        this.#module = module;
        this.#table = module.call("table", "table");
        const [profile, alpha, map] = module.texts();
        this.#naming = naming({ profile, alpha, map });
    }

    /** The points of a query by its keywords: `points({ bbox: [0, 0, 10, 10], spacing: 1, seed: 7 })`. */
    points(/** @type {Body} */ keywords) {
        const query = body(keywords);
        // Sets without a region are checked as well.
        this.#set(read(query, this.#naming));
        return new PointSet(this, query);
    }

    /** The place of a set in the module, with what is known of it. */
    #set(/** @type {ReturnType<typeof read>} */ { amount, attributes, key, numbers, range, variants }) {
        const known = this.#sets.get(key);
        if (known) {
            this.#sets.delete(key);
            this.#sets.set(key, known);
            return known;
        }
        const at = this.#module.call("set", amount, this.#table, ...numbers);
        const names = variants.map(([name]) => name);
        try {
            this.#module.write(variants.map(([, weight]) => weight), `${attributes.join()}\n${names.join()}`);
            this.#module.call("attributes", "attributes", at, names.length, ...range);
        } catch (error) {
            this.#module.calls.free_set(at);
            throw error;
        }
        const made = { at, attributes, names };
        this.#sets.set(key, made);
        if (this.#sets.size > KEPT) {
            const [[oldest, { at: free }]] = this.#sets;
            this.#sets.delete(oldest);
            this.#module.calls.free_set(free);
        }
        return made;
    }

    plan(/** @type {string} */ _, /** @type {Body} */ query) {
        const wanted = read(query, this.#naming);
        if (!wanted.region) throw fault("region", null, "is missing", "one of bbox, chunk, circle");
        const set = this.#set(wanted);
        const { call, values, reach } = wanted.region;
        checkReach(wanted.least, reach);
        const plan = this.#module.call(call, "region", set.at, ...values);
        return new LitePlan(this.#module, plan, set, call === "chunk");
    }

    nearest(/** @type {Body} */ { at, k, radius, ...set }) {
        const wanted = read(set, this.#naming, { at, k, radius });
        const known = this.#set(wanted);
        const [x, y] = /** @type {number[]} */ (wanted.at);
        const few = wanted.k ?? (wanted.radius === undefined ? 1 : 0);
        const count = this.#module.call("nearest", "at", known.at, x, y, few, wanted.radius ?? Infinity);
        return this.#found(wanted.least, count, known, true);
    }

    point(/** @type {string} */ id, /** @type {Body} */ set) {
        const wanted = read(set, this.#naming);
        const known = this.#set(wanted);
        const count = this.#module.call("point", "id", known.at, ...integers(id, PLANE));
        if (!count) throw new StrewError(`the set has no point ${id}`, "no-such-point");
        return this.#found(wanted.least, count, known)[0];
    }

    /** @param {number | undefined} least @param {Parameters<LiteModule["points"]>} of */
    #found(least, ...of) {
        const found = this.#module.points(...of);
        checkReach(least, Math.max(0, ...found.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)])));
        return found;
    }

    holdField() {
        return none("fields");
    }
}

/** The points of an area. @implements {Plan<"here">} */
class LitePlan extends HeldPlan {
    #module;
    #set;
    #isRelative;

    /** @param {LiteModule} module @param {number} plan @param {LiteSet} set @param {boolean} isRelative */
    constructor(module, plan, set, isRelative) {
        super(module.plans, plan);
        this.#isRelative = isRelative;
        this.#module = module;
        this.#set = set;
    }

    #count() {
        const count = BigInt.asUintN(64, this.#module.calls.count(this.place));
        if (count === 2n ** 64n - 1n) throw new StrewError("2^64 points or more", "too-many-points");
        return count;
    }

    count() {
        return numberOf(this.#count());
    }

    /** What a call outputs of the points. @type {<Made>(name: LiteOutput, kind: Kind<Made>) => Made} */
    #output(name, kind) {
        const count = this.#count();
        if (count > MOST_POINTS) {
            const words = `the region holds ${count} points, and an array has room for at most ${MOST_POINTS}`;
            throw new StrewError(`${words}: request a smaller region, or chunks`, "too-many-points");
        }
        this.#module.call(name, name, this.place);
        return new kind(this.#module.output());
    }

    coordinates() {
        return this.#output("coordinates", Float64Array);
    }

    #corner() {
        this.#module.call("origin", "origin", this.place);
        return [...new Float64Array(this.#module.output())];
    }

    offsets() {
        return { at: this.#output("offsets", Float32Array), origin: this.#corner() };
    }

    origin() {
        return this.#isRelative ? this.#corner() : [0, 0];
    }

    columns() {
        const count = Number(this.#count());
        const words = this.#output("columns", BigInt64Array).buffer;
        const { attributes, names } = this.#set;
        /** @type {Further} */
        const further = new Map();
        attributes.forEach((name, i) => {
            const values = new Float64Array(words, 8 * count * (2 + i), count);
            if (name === "variant") further.set(name, { names, values: Int32Array.from(values) });
            else further.set(name, { names: null, values: values.slice() });
        });
        return { ids: new BigInt64Array(words.slice(0, 16 * count)), at: this.coordinates(), further };
    }

    rows() {
        return rowsOf(this.offsets(), this.columns().further);
    }

    resolved() {
        return none("echo of queries");
    }

    split() {
        return none("parts of answers");
    }

    document() {
        return none("formats");
    }
}

// Bundlers copy the files of literal URLs.
const WASM = () => new URL("./lite.wasm", import.meta.url);
const TABLE = () => new URL("./tables/blue-5-sqrt3-over-2-s.strew", import.meta.url);

/** Loads the module and its table. @type {OpenLite} */
export async function open({ table, wasm } = {}) {
    const files = await Promise.all([compile(wasm ?? WASM(), "wasm"), content(table ?? TABLE(), "table")]);
    const [compiled, file] = files;
    const module = new LiteModule(await WebAssembly.instantiate(compiled, {}));
    module.write([], file);
    return new Lite(module);
}
