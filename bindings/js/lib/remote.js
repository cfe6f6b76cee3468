// Points that a daemon makes, over HTTP. Everything is a promise.

import { StrewError } from "./error.js";
import { Source } from "./points.js";
import { OF_DOCUMENTS, parsed, text } from "./query.js";

class Daemon extends Source {
    #url;
    #headers;

    constructor(url, key) {
        super();
        this.#url = String(url).replace(/\/+$/, "");
        this.#headers = key ? { authorization: `Bearer ${key}` } : {};
    }

    /** The response to a request, if it is a good one. */
    async request(path, body) {
        const post = { method: "POST", body, headers: { ...this.#headers, "content-type": "application/json" } };
        const response = await fetch(this.#url + path, body === undefined ? { headers: this.#headers } : post);
        if (response.ok) return response;
        const content = await response.text();
        throw refusal(response.status, content);
    }

    async json(path, body) {
        return (await this.request(path, body)).json();
    }

    plan(_, query) {
        return new RemotePlan(this, query);
    }

    async nearest(address) {
        return (await this.json(`/v1/nearest?${address}`)).neighbors;
    }

    async point(id, address) {
        return (await this.json(`/v1/points/${encodeURIComponent(id)}?${address}`)).point;
    }

    async holdField(body) {
        return (await this.json("/v1/fields", body)).name;
    }
}

/** What is wrong, from a problem document. Proxies answer with other content. */
function refusal(status, content) {
    let problem;
    try {
        problem = JSON.parse(content);
    } catch {
        // Not JSON.
    }
    if (typeof problem?.detail !== "string") {
        return new StrewError(`HTTP ${status}: ${content.slice(0, 200)}`, `http-${status}`);
    }
    const kind = typeof problem.type === "string" ? problem.type.split(":").at(-1) : `http-${status}`;
    return new StrewError(problem.detail, kind, Array.isArray(problem.errors) ? problem.errors : []);
}

/** The header `strew-origin`. */
const originOf = (response) => response.headers.get("strew-origin")?.split(",").map(Number) ?? [0, 0];

/** A query of a daemon. */
class RemotePlan {
    #daemon;
    #query;
    #known;

    constructor(daemon, query) {
        this.#daemon = daemon;
        this.#query = { ...query };
        for (const name of OF_DOCUMENTS) delete this.#query[name];
    }

    /** Forgets what is known of the answer. */
    free() {
        this.#known = undefined;
    }

    #points(more) {
        return this.#daemon.request("/v1/points:query", text({ ...this.#query, ...more }));
    }

    async #json(path, more = {}) {
        return parsed(await (await this.#daemon.request(path, text({ ...this.#query, ...more }))).text());
    }

    async count() {
        return (await this.#json("/v1/points:split?parts=1")).count;
    }

    async resolved() {
        const isWindow = ["offset", "limit", "cursor"].some((name) => name in this.#query);
        if (!isWindow) return (await this.#json("/v1/count")).query;
        // Windows are counted by `split`, which does not repeat the query: one point does.
        const { query } = await this.#json("/v1/points:query", { format: "json", limit: 1 });
        const { format, relative_to, limit, ...rest } = query;
        return "limit" in this.#query ? { ...rest, limit: this.#query.limit } : rest;
    }

    /** The columns and the origin, from the headers of an answer with one point at most. */
    async #requestHead() {
        const response = await this.#points({ format: "f64", limit: 1 });
        await response.arrayBuffer();
        return { columns: JSON.parse(response.headers.get("strew-columns")), origin: originOf(response) };
    }

    #head() {
        if (this.#known) return this.#known;
        const head = this.#requestHead();
        this.#known = head;
        // What failed is requested again by the next call.
        head.catch(() => {
            if (this.#known === head) this.#known = undefined;
        });
        return head;
    }

    async origin() {
        return (await this.#head()).origin;
    }

    /** The coordinates of an answer whose rows are numbers, x and y first. */
    async #coordinates(format, kind) {
        const response = await this.#points({ format });
        const count = Number(response.headers.get("strew-count"));
        const values = new kind(await response.arrayBuffer());
        const each = values.length / count;
        const pair = (_, i) => values[(i >> 1) * each + (i & 1)];
        const xy = each === 2 || !count ? values : kind.from({ length: 2 * count }, pair);
        return { xy, origin: originOf(response) };
    }

    async xy() {
        return (await this.#coordinates("f64", Float64Array)).xy;
    }

    xyF32() {
        return this.#coordinates("f32", Float32Array);
    }

    async columns() {
        // The numbers of JSON read back to the same bits.
        const [{ columns }, { points }] = await Promise.all([
            this.#head(),
            this.#points({ format: "json" }).then((response) => response.json()),
        ]);
        const ids = BigInt64Array.from(points.flatMap(({ id }) => id.split(":").map(BigInt)));
        const xy = Float64Array.from(points.flatMap(({ x, y }) => [x, y]));
        const further = columns.slice(2).map((column) => [column.name, valuesOf(column, points)]);
        return { ids, xy, further: new Map(further) };
    }

    async split(parts) {
        const answer = await this.#json(`/v1/points:split?parts=${encodeURIComponent(parts)}`);
        return answer.parts.map(({ query, count }) => ({ cursor: query.cursor, limit: count }));
    }

    async document(options) {
        return new Uint8Array(await (await this.#points(options)).arrayBuffer());
    }
}

/** The values of a column: numbers, or indices of names. */
function valuesOf({ name, names, names_left_out }, points) {
    const values = points.map((point) => point[name] ?? null);
    if (!names && !names_left_out) return { names: null, values: Float64Array.from(values, (value) => value ?? NaN) };
    // Headers have no room for very many names: those of the points are then in the order of their first points.
    const known = names ?? [...new Set(values.filter((value) => value !== null))];
    const places = new Map(known.map((text, place) => [text, place]));
    return { names: known, values: Int32Array.from(values, (value) => places.get(value) ?? -1) };
}

/** A daemon, with the functions of what `open` returns; its answers are promises. */
export function connect(url, { key } = {}) {
    return new Daemon(url, key);
}
