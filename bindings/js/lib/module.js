// The WebAssembly module: the C library of bindings/c, its calls and its memory.

import { StrewError } from "./error.js";
import { Held } from "./held.js";
import { parsed } from "./query.js";
/** @import { Call, Calls, Kind, Passed, Room } from "./types.js" */

const ENCODER = new TextEncoder();
const DECODER = new TextDecoder();

/** A compiled module with its memory. Pointers are numbers: `>>> 0` makes those above 2 GiB positive. */
export class Module {
    /** Its plans, by their owners. */
    plans = new Held((plan) => this.calls.strew_plan_free(plan));

    constructor(/** @type {WebAssembly.Instance} */ { exports }) {
        this.calls = /** @type {Calls} */ (exports);
    }

    /**
     * Runs `work(room)`. Memory that it allocates by `room(bytes)` is released afterwards.
     * @type {<Made>(work: (room: Room) => Made) => Made}
     */
    scoped(work) {
        /** @type {[at: number, bytes: number][]} */
        const held = [];
        try {
            return work((bytes) => {
                const at = this.calls.strew_allocate(bytes) >>> 0;
                if (!at) throw new RangeError("there is not enough memory");
                held.push([at, bytes]);
                return at;
            });
        } finally {
            for (const [at, bytes] of held) this.calls.strew_release(at, bytes);
        }
    }

    /** Calls a function that returns a code. Texts and arrays are passed as the addresses of their copies. */
    call(/** @type {Call} */ name, /** @type {Passed[]} */ ...values) {
        const code = this.scoped((room) => {
            const passed = values.map((value) => (typeof value === "number" ? value : this.copied(room, value)));
            return this.calls[name](...passed);
        });
        if (code === 0) return;
        const document = new Uint8Array(this.memory, this.calls.strew_error_document() >>> 0);
        const { kind, detail, errors } = JSON.parse(DECODER.decode(document.subarray(0, document.indexOf(0))));
        throw new StrewError(detail, kind, errors);
    }

    /** Memory as it is now: a call may make it grow, and older views are then empty. */
    get memory() {
        return this.calls.memory.buffer;
    }

    /** The address of a copy of an array, or of a text with a zero after it. */
    copied(/** @type {Room} */ room, /** @type {Exclude<Passed, number>} */ value) {
        const { buffer, byteOffset, byteLength } = typeof value === "string" ? ENCODER.encode(`${value}\0`) : value;
        const at = room(byteLength);
        new Uint8Array(this.memory, at, byteLength).set(new Uint8Array(buffer, byteOffset, byteLength));
        return at;
    }

    /** The handle that a call makes. It writes it to its last argument. */
    handle(/** @type {Call} */ name, /** @type {Passed[]} */ ...values) {
        return this.filled(Uint32Array, 1, (out) => this.call(name, ...values, out))[0];
    }

    /** The bytes that a call makes. */
    bytes(/** @type {Call} */ name, /** @type {Passed[]} */ ...values) {
        const made = this.handle(name, ...values);
        const at = this.calls.strew_bytes_data(made) >>> 0;
        const length = this.calls.strew_bytes_length(made) >>> 0;
        const copy = new Uint8Array(this.memory, at, length).slice();
        this.calls.strew_bytes_free(made);
        return copy;
    }

    /** The JSON value that a call makes, with integers of any size. */
    json(/** @type {Call} */ name, /** @type {Passed[]} */ ...values) {
        return parsed(DECODER.decode(this.bytes(name, ...values)));
    }

    /** An array, filled at its place. @type {<T>(kind: Kind<T>, length: number, fill: (at: number) => void) => T} */
    filled(kind, length, fill) {
        const bytes = length * kind.BYTES_PER_ELEMENT;
        return this.scoped((room) => {
            const at = room(bytes);
            fill(at);
            return new kind(this.memory.slice(at, at + bytes));
        });
    }
}
