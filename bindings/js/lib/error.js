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

/** What is wrong with one value, in the words of REST. */
export function fault(field, value, detail, allowed) {
    const shown = value === null ? "" : ` = \`${value}\``;
    const faults = [{ field, value, detail, allowed }];
    return new StrewError(`\`${field}\`${shown}: ${detail}; allowed: ${allowed}`, "invalid-query", faults);
}

/** A daemon that cannot be reached, or whose answer broke off. */
export class Disconnected extends Error {
    name = "Disconnected";
}
