// Points that are made in this page or process.

import { Module } from "./module.js";
import { Source } from "./points.js";
import { PLANE, SPACE } from "./query.js";

/** The table that answers by default, and by default the only one that is loaded. */
export const DEFAULT_TABLES = ["blue-5-sqrt3-over-2-m.strew"];

/** The table for points in space that answers by default. */
export const SPACE_TABLES = ["space-blue-5-sqrt3-over-2-r16.strew"];

/** The calls of the module, and the bytes of a point. */
const CALLS = new Map([
    [
        PLANE,
        {
            plan: "strew_plan_query",
            origin: "strew_plan_origin",
            fill: "strew_plan_fill_xy",
            near: "strew_plan_fill_xy_f32",
            ids: "strew_plan_fill_ids",
            nearest: "strew_nearest",
            point: "strew_point_by_id",
            bytes: 40,
        },
    ],
    [
        SPACE,
        {
            plan: "strew_space_plan_query",
            origin: "strew_space_origin",
            fill: "strew_space_fill_xyz",
            near: "strew_space_fill_xyz_f32",
            ids: "strew_space_fill_ids",
            nearest: "strew_space_nearest",
            point: "strew_space_point_by_id",
            bytes: 56,
        },
    ],
]);

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
            module.call(CALLS.get(dimension).plan, this.#library, module.text(room, query), out);
            return new Plan(module, module.pointer(out), dimension);
        });
    }

    nearest(address, dimension) {
        const module = this.#module;
        return module.scoped((room) =>
            module.json(CALLS.get(dimension).nearest, room, this.#library, module.text(room, address), 0, 0, 0),
        );
    }

    point(id, address, dimension) {
        const module = this.#module;
        const calls = CALLS.get(dimension);
        return module.scoped((room) => {
            const parts = integers(id, dimension);
            const set = module.text(room, address);
            return module.json(calls.point, room, this.#library, set, ...parts, room(calls.bytes));
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

function integers(id, dimension) {
    const parts = /^-?\d+(:-?\d+)+$/.test(id) ? id.split(":").map(BigInt) : [];
    if (parts.length === dimension.axes.length) return parts;
    const allowed =
        dimension === SPACE
            ? "three integers joined by colons, such as -31:52:7"
            : "two integers joined by a colon, such as -31:52";
    throw new TypeError(`${JSON.stringify(id)} is no id: ${allowed}`);
}

/** A planned query. */
class Plan {
    #module;
    #plan;
    #calls;
    #axes;

    constructor(module, plan, dimension) {
        this.#module = module;
        this.#plan = plan;
        this.#calls = CALLS.get(dimension);
        this.#axes = dimension.axes.length;
        module.held(this, plan);
    }

    /** Frees the memory. The plan has no points afterwards. */
    free() {
        if (this.#plan) this.#module.free(this, this.#plan);
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

    /** The points that a buffer is made for. More are refused by the call, before it looks at the buffer. */
    #few() {
        const count = this.count();
        return typeof count === "number" && count < 2 ** 28 ? count : 0;
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
        return this.#filled(Float64Array, this.#axes, this.#calls.fill);
    }

    offsets() {
        const module = this.#module;
        const [count, axes] = [this.#few(), this.#axes];
        return module.scoped((room) => {
            const from = room(8 * axes);
            const fill = (at) => module.call(this.#calls.near, this.#plan, at, count, from);
            const at = module.filled(Float32Array, axes * count, room, fill);
            return { at, origin: [...new Float64Array(module.memory, from, axes)] };
        });
    }

    origin() {
        return this.#module.scoped((room) => {
            const out = room(8 * this.#axes);
            this.#module.call(this.#calls.origin, this.#plan, out);
            return [...new Float64Array(this.#module.memory, out, this.#axes)];
        });
    }

    columns() {
        const ids = this.#filled(BigInt64Array, this.#axes, this.#calls.ids);
        const listed = this.#module.scoped((room) => this.#module.json("strew_plan_columns", room, this.#plan));
        const further = listed.map(({ name, names }) => {
            const [kind, call] = names ? [Int32Array, "codes"] : [Float64Array, "numbers"];
            return [name, { names, values: this.#filled(kind, 1, `strew_plan_fill_${call}`, name) }];
        });
        return { ids, at: this.coordinates(), further: new Map(further) };
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

const isNode = typeof process !== "undefined" && Boolean(process.versions?.node);

/** The bytes of a file of this package, of an address, or of bytes. */
async function content(what, folder) {
    if (what instanceof ArrayBuffer) return new Uint8Array(what);
    if (ArrayBuffer.isView(what)) return new Uint8Array(what.buffer, what.byteOffset, what.byteLength);
    const isAddress = what instanceof URL || /^[a-z]+:\/\//.test(what);
    const url = isAddress ? new URL(what) : new URL(what, new URL(folder, import.meta.url));
    if (isNode && url.protocol === "file:") {
        const { readFile } = await import("node:fs/promises");
        return readFile(url);
    }
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${url}: HTTP ${response.status}`);
    return new Uint8Array(await response.arrayBuffer());
}

/** Loads the module and tables. */
export async function open({ tables = DEFAULT_TABLES, wasm = "strew.wasm" } = {}) {
    const compiled = wasm instanceof WebAssembly.Module ? wasm : WebAssembly.compile(await content(wasm, "./"));
    const files = await Promise.all(tables.map((table) => content(table, "./tables/")));
    const module = new Module(await WebAssembly.instantiate(await compiled, {}));
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
