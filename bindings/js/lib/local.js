// Points that are made in this page or process.

import { StrewError } from "./error.js";
import { compile, content, isAddress } from "./files.js";
import { HeldPlan } from "./held.js";
import { Module } from "./module.js";
import { Source, rowsOf } from "./points.js";
import { PLANE, address, integers, numberOf } from "./query.js";
/** @import { Backend, Body, Call, Content, Dimension, Further, Kind, Plan } from "./types.js" */

/** The table that answers by default, and by default the only one that is loaded. */
export const DEFAULT_TABLES = ["blue-5-sqrt3-over-2-m.strew"];

/** The table for points in space that answers by default. */
export const SPACE_TABLES = ["space-blue-5-sqrt3-over-2-r16.strew"];

/** The bytes of a point as C has it: an id of three integers, three coordinates and a distance. */
const POINT_BYTES = 56;

/** This page or process. @implements {Backend<"here">} */
export class Local {
    side = /** @type {const} */ ("here");
    #module;
    #library;

    constructor(/** @type {Module} */ module, /** @type {number} */ library) {
        this.#module = module;
        this.#library = library;
    }

    plan(/** @type {string} */ query, /** @type {unknown} */ _, dimension = PLANE) {
        const plan = this.#module.handle("strew_plan_query", this.#library, dimension.axes.length, query);
        return new LocalPlan(this.#module, plan, dimension);
    }

    nearest(/** @type {Body} */ values, /** @type {Dimension} */ { axes }) {
        return this.#module.json("strew_nearest", this.#library, axes.length, address(values), 0, 0, 0);
    }

    point(/** @type {string} */ id, /** @type {Body} */ values, /** @type {Dimension} */ dimension) {
        const parts = BigInt64Array.from(integers(id, dimension));
        const room = new Uint8Array(POINT_BYTES);
        return this.#module.json("strew_point_by_id", this.#library, parts.length, address(values), parts, room);
    }

    holdField(/** @type {string} */ body) {
        return new TextDecoder().decode(this.#module.bytes("strew_library_hold_field", this.#library, body));
    }
}

/** A planned query. @implements {Plan<"here">} */
class LocalPlan extends HeldPlan {
    #module;
    #axes;

    constructor(/** @type {Module} */ module, /** @type {number} */ plan, /** @type {Dimension} */ { axes }) {
        super(module.plans, plan);
        this.#module = module;
        this.#axes = axes.length;
    }

    count() {
        const fill = (/** @type {number} */ at) => this.#module.call("strew_plan_count", this.place, at);
        return numberOf(this.#module.filled(BigUint64Array, 1, fill)[0]);
    }

    /** The number of points, for a buffer. The memory of a module has room for fewer than 2²⁸. */
    #few() {
        const count = this.count();
        if (count < 2 ** 28) return count;
        const words = `the region holds ${count} points, and an array has room for at most ${2 ** 28 - 1}`;
        throw new StrewError(`${words}: request a smaller region, chunks, or parts by split`, "too-many-points");
    }

    /**
     * An array with `each` numbers per point.
     * @type {<Made>(kind: Kind<Made>, each: number, call: Call, ...more: string[]) => Made}
     */
    #filled(kind, each, call, ...more) {
        const numbers = each * this.#few();
        return this.#module.filled(kind, numbers, (at) => this.#module.call(call, this.place, ...more, at, numbers));
    }

    coordinates() {
        return this.#filled(Float64Array, this.#axes, "strew_plan_fill_coordinates");
    }

    offsets() {
        const [module, count, axes] = [this.#module, this.#few(), this.#axes];
        return module.scoped((room) => {
            const from = room(8 * axes);
            const fill = (/** @type {number} */ at) =>
                module.call("strew_plan_fill_coordinates_f32", this.place, at, axes * count, from);
            const at = module.filled(Float32Array, axes * count, fill);
            return { at, origin: [...new Float64Array(module.memory, from, axes)] };
        });
    }

    origin() {
        const fill = (/** @type {number} */ at) => this.#module.call("strew_plan_origin", this.place, at);
        return [...this.#module.filled(Float64Array, this.#axes, fill)];
    }

    columns() {
        const ids = this.#filled(BigInt64Array, this.#axes, "strew_plan_fill_ids");
        /** @type {Further} */
        const further = new Map();
        for (const { name, names } of this.#module.json("strew_plan_columns", this.place)) {
            if (names) further.set(name, { names, values: this.#filled(Int32Array, 1, "strew_plan_fill_codes", name) });
            else further.set(name, { names, values: this.#filled(Float64Array, 1, "strew_plan_fill_numbers", name) });
        }
        return { ids, at: this.coordinates(), further };
    }

    rows() {
        return rowsOf(this.offsets(), this.columns().further);
    }

    resolved() {
        return this.#module.json("strew_plan_resolved", this.place);
    }

    split(/** @type {number} */ parts) {
        return this.#module.json("strew_plan_split", this.place, parts);
    }

    document(/** @type {Body} */ options) {
        const on = (/** @type {unknown} */ value) => (typeof value === "boolean" ? (value ? "on" : "off") : value);
        const wanted = Object.entries(options).map(([name, value]) => `${name}=${on(value)}`);
        return this.#module.bytes("strew_plan_document", this.place, wanted.join("&"));
    }
}

// Bundlers copy the files of literal URLs. Nothing is evaluated before it is loaded.
const WASM = () => new URL("./strew.wasm", import.meta.url);
const TABLES = new Map([
    ["blue-5-sqrt3-over-2-m.strew", () => new URL("./tables/blue-5-sqrt3-over-2-m.strew", import.meta.url)],
    ["blue-5-sqrt3-over-2-s.strew", () => new URL("./tables/blue-5-sqrt3-over-2-s.strew", import.meta.url)],
    [
        "space-blue-5-sqrt3-over-2-r16.strew",
        () => new URL("./tables/space-blue-5-sqrt3-over-2-r16.strew", import.meta.url),
    ],
]);

/** A table by its name, or its address or bytes. */
function table(/** @type {Content} */ what) {
    if (typeof what !== "string" || isAddress(what)) return what;
    const known = TABLES.get(what);
    if (known) return known();
    const names = [...TABLES.keys()].join(", ");
    throw new StrewError(
        `no table ${JSON.stringify(what)}; this package has ${names}, the package strew-tables all others, and ` +
            "tables may be URLs or bytes",
        "no-such-table",
    );
}

/** Loads the module and tables. @type {typeof import("./index.js").open} */
export async function open({ tables = DEFAULT_TABLES, wasm } = {}) {
    const [compiled, ...files] = await Promise.all([
        compile(wasm ?? WASM(), "wasm"),
        ...tables.map((name) => content(table(name), "tables")),
    ]);
    const module = new Module(await WebAssembly.instantiate(compiled, {}));
    const library = module.scoped((room) => {
        const places = Uint32Array.from(files, (file) => module.copied(room, file));
        const lengths = Uint32Array.from(files, (file) => file.length);
        return module.handle("strew_library_of_tables", places, lengths, files.length);
    });
    return new Source(new Local(module, library));
}
