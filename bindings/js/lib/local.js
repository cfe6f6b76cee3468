// Points that are made in this page or process.

import { StrewError } from "./error.js";
import { compile, content, isAddress } from "./files.js";
import { Module } from "./module.js";
import { Source, rowsOf } from "./points.js";
import { PLANE, address, integers } from "./query.js";

/** The table that answers by default, and by default the only one that is loaded. */
export const DEFAULT_TABLES = ["blue-5-sqrt3-over-2-m.strew"];

/** The table for points in space that answers by default. */
export const SPACE_TABLES = ["space-blue-5-sqrt3-over-2-r16.strew"];

/** The bytes of a point as C has it: an id of three integers, three coordinates and a distance. */
const POINT_BYTES = 56;

/** This page or process. */
export class Local extends Source {
    isLocal = true;
    #module;
    #library;

    constructor(module, library) {
        super();
        this.#module = module;
        this.#library = library;
    }

    plan(query, _, dimension = PLANE) {
        const module = this.#module;
        return module.scoped((room) => {
            const out = room(4);
            module.call("strew_plan_query", this.#library, dimension.axes.length, module.text(room, query), out);
            return new Plan(module, module.pointer(out), dimension);
        });
    }

    nearest(values, dimension) {
        const module = this.#module;
        return module.scoped((room) => {
            const set = module.text(room, address(values));
            return module.json("strew_nearest", room, this.#library, dimension.axes.length, set, 0, 0, 0);
        });
    }

    point(id, values, dimension) {
        const module = this.#module;
        return module.scoped((room) => {
            const parts = integers(id, dimension);
            const set = module.text(room, address(values));
            const at = room(8 * parts.length);
            new BigInt64Array(module.memory, at, parts.length).set(parts);
            return module.json("strew_point_by_id", room, this.#library, parts.length, set, at, room(POINT_BYTES));
        });
    }

    holdField(body) {
        const module = this.#module;
        const held = module.scoped((room) =>
            module.bytes("strew_library_hold_field", room, this.#library, module.text(room, body)),
        );
        return new TextDecoder().decode(held);
    }
}

/** A planned query. */
class Plan {
    #module;
    #plan;
    #axes;

    constructor(module, plan, dimension) {
        this.#module = module;
        this.#plan = plan;
        this.#axes = dimension.axes.length;
        module.plans.add(this, plan);
    }

    get isFree() {
        return !this.#plan;
    }

    /** Frees the memory. The plan has no points afterwards. */
    free() {
        if (this.#plan) this.#module.plans.remove(this, this.#plan);
        this.#plan = 0;
    }

    count() {
        return this.#module.scoped((room) => {
            const out = room(8);
            this.#module.call("strew_plan_count", this.#plan, out);
            const count = new DataView(this.#module.memory).getBigUint64(out, true);
            return count <= BigInt(Number.MAX_SAFE_INTEGER) ? Number(count) : count;
        });
    }

    /** The number of points, for a buffer. The memory of a module has room for fewer than 2²⁸. */
    #few() {
        const count = this.count();
        if (count < 2 ** 28) return count;
        const words = `the region holds ${count} points, and an array has room for at most ${2 ** 28 - 1}`;
        throw new StrewError(`${words}: request a smaller region, chunks, or parts by split`, "too-many-points");
    }

    /** An array with `each` numbers per point. */
    #filled(kind, each, call, ...more) {
        const module = this.#module;
        const few = this.#few();
        return module.scoped((room) => {
            const values = more.map((value) => (typeof value === "string" ? module.text(room, value) : value));
            return module.filled(kind, each * few, room, (at) => module.call(call, this.#plan, ...values, at, few));
        });
    }

    coordinates() {
        return this.#filled(Float64Array, this.#axes, "strew_plan_fill_coordinates");
    }

    offsets() {
        const module = this.#module;
        const [count, axes] = [this.#few(), this.#axes];
        return module.scoped((room) => {
            const from = room(8 * axes);
            const fill = (at) => module.call("strew_plan_fill_coordinates_f32", this.#plan, at, count, from);
            const at = module.filled(Float32Array, axes * count, room, fill);
            return { at, origin: [...new Float64Array(module.memory, from, axes)] };
        });
    }

    origin() {
        return this.#module.scoped((room) => {
            const out = room(8 * this.#axes);
            this.#module.call("strew_plan_origin", this.#plan, out);
            return [...new Float64Array(this.#module.memory, out, this.#axes)];
        });
    }

    columns() {
        const ids = this.#filled(BigInt64Array, this.#axes, "strew_plan_fill_ids");
        const listed = this.#module.scoped((room) => this.#module.json("strew_plan_columns", room, this.#plan));
        const further = listed.map(({ name, names }) => {
            const [kind, call] = names ? [Int32Array, "codes"] : [Float64Array, "numbers"];
            return [name, { names, values: this.#filled(kind, 1, `strew_plan_fill_${call}`, name) }];
        });
        return { ids, at: this.coordinates(), further: new Map(further) };
    }

    rows() {
        return rowsOf(this.offsets(), this.columns().further);
    }

    resolved() {
        return this.#module.scoped((room) => this.#module.exact("strew_plan_resolved", room, this.#plan));
    }

    split(parts) {
        return this.#module.scoped((room) => this.#module.exact("strew_plan_split", room, this.#plan, parts));
    }

    document(options) {
        const on = (value) => (typeof value === "boolean" ? (value ? "on" : "off") : value);
        const wanted = Object.entries(options).map(([name, value]) => `${name}=${on(value)}`);
        const module = this.#module;
        return module.scoped((room) =>
            module.bytes("strew_plan_document", room, this.#plan, module.text(room, wanted.join("&"))),
        );
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
function table(what) {
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

/** Loads the module and tables. */
export async function open({ tables = DEFAULT_TABLES, wasm } = {}) {
    const [compiled, ...files] = await Promise.all([
        compile(wasm ?? WASM(), "wasm"),
        ...tables.map((name) => content(table(name), "tables")),
    ]);
    const module = new Module(await WebAssembly.instantiate(compiled, {}));
    const library = module.scoped((room) => {
        const places = files.map((file) => {
            const at = room(file.length);
            new Uint8Array(module.memory, at, file.length).set(file);
            return at;
        });
        const listed = (numbers) => {
            const at = room(4 * numbers.length);
            new Uint32Array(module.memory, at, numbers.length).set(numbers);
            return at;
        };
        const lengths = listed(files.map((file) => file.length));
        const out = room(4);
        module.call("strew_library_of_tables", listed(places), lengths, files.length, out);
        return module.pointer(out);
    });
    return new Local(module, library);
}
