// The errors of the package, in the words of the REST API.
/** @import { Fault } from "./index.js" */

/** A query that has no answer: see index.d.ts. */
export class StrewError extends Error {
    /** @param {string} message @param {string} kind @param {Fault[]} faults */
    constructor(message, kind = "", faults = []) {
        super(message);
        this.name = "StrewError";
        this.kind = kind;
        this.faults = faults;
    }
}

/** What is wrong with some values, in the words of REST. */
export function invalid(/** @type {Fault[]} */ faults) {
    const words = (/** @type {Fault} */ { field, value, detail, allowed }) =>
        `\`${field}\`${value === null ? "" : ` = \`${value}\``}: ${detail}; allowed: ${allowed}`;
    return new StrewError(faults.map(words).join("; "), "invalid-query", faults);
}

/** One wrong value. @type {(field: string, value: string | null, detail: string, allowed: string) => StrewError} */
export const fault = (field, value, detail, allowed) => invalid([{ field, value, detail, allowed }]);

/** A daemon that cannot be reached, or whose answer broke off. */
export class Disconnected extends Error {
    name = "Disconnected";
}
