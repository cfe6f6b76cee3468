// The WebAssembly module: the C library of bindings/c, its calls and its memory.

import { StrewError } from "./error.js";
import { Held } from "./held.js";
import { parsed } from "./query.js";

const ENCODER = new TextEncoder();
const DECODER = new TextDecoder();

/** A compiled module with its memory. Pointers are numbers: `>>> 0` makes those above 2 GiB positive. */
export class Module {
    /** Its plans, by their owners. */
    plans = new Held((plan) => this.calls.strew_plan_free(plan));

    constructor(instance) {
        this.calls = instance.exports;
    }

    /** Runs `work(room)`. Memory that it allocates by `room(bytes)` is released afterwards. */
    scoped(work) {
        const held = [];
        const room = (bytes) => {
            const at = this.calls.strew_allocate(bytes) >>> 0;
            if (!at) throw new RangeError("there is not enough memory");
            held.push([at, bytes]);
            return at;
        };
        try {
            return work(room);
        } finally {
            for (const [at, bytes] of held) this.calls.strew_release(at, bytes);
        }
    }

    /** Calls a function that returns a code. */
    call(name, ...values) {
        if (this.calls[name](...values) === 0) return;
        const { kind, detail, errors } = JSON.parse(this.#text(this.calls.strew_error_document() >>> 0));
        throw new StrewError(detail, kind, errors);
    }

    /** Memory as it is now: a call may make it grow, and older views are then empty. */
    get memory() {
        return this.calls.memory.buffer;
    }

    /** The number that a call has put at a place. */
    pointer(at) {
        return new DataView(this.memory).getUint32(at, true);
    }

    #text(at) {
        const bytes = new Uint8Array(this.memory, at);
        return DECODER.decode(bytes.subarray(0, bytes.indexOf(0)));
    }

    /** The address of a copy of a text, with a zero after it. */
    text(room, text) {
        const bytes = ENCODER.encode(text);
        const at = room(bytes.length + 1);
        const memory = new Uint8Array(this.memory, at, bytes.length + 1);
        memory.set(bytes);
        memory[bytes.length] = 0;
        return at;
    }

    /** The bytes that a call makes. It writes their handle to its last argument. */
    bytes(name, room, ...values) {
        const out = room(4);
        this.call(name, ...values, out);
        const made = this.pointer(out);
        const at = this.calls.strew_bytes_data(made) >>> 0;
        const length = this.calls.strew_bytes_length(made) >>> 0;
        const copy = new Uint8Array(this.memory, at, length).slice();
        this.calls.strew_bytes_free(made);
        return copy;
    }

    /** The JSON value that a call makes. */
    json(name, room, ...values) {
        return JSON.parse(DECODER.decode(this.bytes(name, room, ...values)));
    }

    /** The JSON value that a call makes, with integers of any size. */
    exact(name, room, ...values) {
        return parsed(DECODER.decode(this.bytes(name, room, ...values)));
    }

    /** An array that a call fills. */
    filled(kind, length, room, fill) {
        const bytes = length * kind.BYTES_PER_ELEMENT;
        const at = room(bytes);
        fill(at);
        return new kind(this.memory.slice(at, at + bytes));
    }
}
