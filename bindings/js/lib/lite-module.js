// The small WebAssembly module, the crate in `lite/`: its calls and its memory.

import { fault } from "./error.js";
import { Held } from "./held.js";
/** @import { LiteCall, LiteCalls, LiteSet } from "./types.js" */
/** @import { SpacePoint } from "./index.js" */

// The module writes numbers of its errors as their bits.
const BITS = /#([0-9a-f]{16})/g;
const decimal = (/** @type {string} */ _, /** @type {string} */ bits) => {
    const value = new DataView(BigUint64Array.of(BigInt(`0x${bits}`)).buffer).getFloat64(0, true);
    const size = Math.abs(value);
    return size === 0 || (1e-5 <= size && size < 1e16) ? `${value}` : value.toExponential().replace("+", "");
};

const ENCODER = new TextEncoder();
const DECODER = new TextDecoder();

/** A compiled module. Its functions take numbers, and read and write two buffers of their own. */
export class LiteModule {
    /** Its plans, by their owners. */
    plans = new Held((plan) => this.calls.free_plan(plan));

    constructor(/** @type {WebAssembly.Instance} */ { exports }) {
        this.calls = /** @type {LiteCalls} */ (exports);
    }

    /** Writes the input of the next call: numbers, then a text or bytes. */
    write(/** @type {number[]} */ numbers, /** @type {string | Uint8Array} */ content) {
        const bytes = typeof content === "string" ? ENCODER.encode(content) : content;
        const at = this.calls.input(8 * numbers.length + bytes.length) >>> 0;
        const view = new DataView(this.calls.memory.buffer);
        numbers.forEach((number, i) => view.setFloat64(at + 8 * i, number, true));
        new Uint8Array(this.calls.memory.buffer, at + 8 * numbers.length, bytes.length).set(bytes);
    }

    /**
     * Calls a function that returns −1 if it fails; `field` is what may be wrong with the query.
     * @type {(name: LiteCall, field: string, ...values: (number | bigint)[]) => number}
     */
    call(name, field, ...values) {
        const result = this.calls[name](...values);
        if (result !== -1) return result;
        const [part, value, problem, allowed] = this.texts().map((words) => words.replace(BITS, decimal));
        const detail = problem || `${part} is ${value}`;
        throw fault(field, value, detail, allowed);
    }

    /** A copy of the output, which is freed. */
    output() {
        const at = this.calls.output() >>> 0;
        const copy = this.calls.memory.buffer.slice(at, at + (this.calls.output_length() >>> 0));
        this.calls.free_output();
        return copy;
    }

    /** The texts of the output, which is freed. */
    texts() {
        return DECODER.decode(this.output()).split("\0");
    }

    /** The points of an output, as objects. */
    points(/** @type {number} */ count, /** @type {LiteSet} */ { attributes, names }, hasDistance = false) {
        const view = new DataView(this.output());
        const each = 8 * (5 + attributes.length);
        return Array.from({ length: count }, (_, i) => {
            const number = (/** @type {number} */ k) => view.getFloat64(i * each + 8 * k, true);
            const integer = (/** @type {number} */ k) => view.getBigInt64(i * each + 8 * k, true);
            const point = { id: `${integer(0)}:${integer(1)}`, x: number(2), y: number(3) };
            if (hasDistance) Object.assign(point, { distance: number(4) });
            const value = (/** @type {string} */ name, k = 0) => (name === "variant" ? names[number(k)] : number(k));
            for (const [k, name] of attributes.entries()) Object.assign(point, { [name]: value(name, 5 + k) });
            return /** @type {SpacePoint} */ (point);
        });
    }
}
