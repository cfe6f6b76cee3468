// The errors of the package, in the words of the REST API.

/** A query that has no answer. */
export class StrewError extends Error {
    /**
     * @param {string} message the words of REST
     * @param {string} kind as in REST's problem types: invalid-query, too-many-points, …
     * @param {object[]} faults everything that is wrong: field, value, detail, allowed
     */
    constructor(message, kind = "", faults = []) {
        super(message);
        this.name = "StrewError";
        this.kind = kind;
        this.faults = faults;
    }
}

/** What is wrong with some values, in the words of REST. */
export function invalid(faults) {
    const words = ({ field, value, detail, allowed }) =>
        `\`${field}\`${value === null ? "" : ` = \`${value}\``}: ${detail}; allowed: ${allowed}`;
    return new StrewError(faults.map(words).join("; "), "invalid-query", faults);
}

/** What is wrong with one value. */
export const fault = (field, value, detail, allowed) => invalid([{ field, value, detail, allowed }]);

/** A daemon that cannot be reached, or whose answer broke off. */
export class Disconnected extends Error {
    name = "Disconnected";
}
