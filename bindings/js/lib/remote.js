// Points that a daemon makes, or one of several, over HTTP. Everything is a promise.
//
// A request goes to the address that answered last, and is sent once more to the next one. Nothing else is kept of
// addresses: balancing, health and longer retries are what proxies are for.

import { Disconnected, StrewError, fault } from "./error.js";
import { OUTPUT } from "./parameters.js";
import { Source } from "./points.js";
import { PLANE, address, parsed, text } from "./query.js";

// The longest wait for `Retry-After`, in seconds.
const PATIENCE = 5;

/** An address of HTTP, or in a page a path of its own server. */
function checkedAddress(text) {
    if (/^https?:\/\/./i.test(text) || (globalThis.location && /^[./]/.test(text))) return text;
    const detail = /^[^/]*:\d+(\/|$)/.test(text) ? "http:// is missing" : "no address of a daemon";
    throw fault("url", text, detail, "http://host:port or https://host:port");
}

function addresses(url) {
    const texts = String(url).split(",");
    return [...new Set(texts.map((text) => checkedAddress(text.trim()).replace(/\/+$/, "")))];
}

const why = ({ cause, message }) => cause?.message || cause?.code || message;

class Daemon extends Source {
    #headers;
    #urls;
    // Which address the next request goes to.
    #place = 0;

    constructor(url, { key }) {
        super();
        this.#headers = key ? { authorization: `Bearer ${key}` } : {};
        this.#urls = addresses(url);
    }

    /** A good response with its whole content, `text` or `arrayBuffer`. A request without an answer is sent once more. */
    async request(path, body, form = "text") {
        const post = { method: "POST", body, headers: { ...this.#headers, "content-type": "application/json" } };
        const options = body === undefined ? { headers: this.#headers } : post;
        const tried = [];
        for (;;) {
            const place = this.#place;
            const url = this.#urls[place];
            const response = await fetch(url + path, options).catch((error) => new Disconnected(why(error)));
            if (response.ok) {
                const lost = (error) => Promise.reject(brokenOff(url, why(error)));
                return { url, headers: response.headers, content: await response[form]().catch(lost) };
            }
            let [error, wait] = [response, "0"];
            if (response instanceof Response) {
                error = refusal(response.status, await response.text().catch(String));
                wait = response.headers.get("retry-after");
                if (response.status !== 503 || wait === null) throw error;
            }
            this.#place = (place + 1) % this.#urls.length;
            tried.push(`${url}: ${error.message}`);
            if (tried.length === 2) {
                error.message = [...new Set(tried)].join("; ");
                throw error;
            }
            const seconds = /^\d+$/.test(wait) ? Math.min(wait, PATIENCE) : PATIENCE;
            await new Promise((ready) => setTimeout(ready, 1000 * seconds));
        }
    }

    async json(path, body) {
        return JSON.parse((await this.request(path, body)).content);
    }

    plan(_, query, dimension = PLANE) {
        return new RemotePlan(this, query, dimension);
    }

    async nearest(values, { root }) {
        return (await this.json(`${root}/nearest?${address(values)}`)).neighbors;
    }

    async point(id, values, { root }) {
        return (await this.json(`${root}/points/${encodeURIComponent(id)}?${address(values)}`)).point;
    }

    async holdField(body) {
        return (await this.json("/v1/fields", body)).name;
    }
}

const brokenOff = (url, why) => new Disconnected(`${url}: the answer broke off: ${why}`);

/** The error that a problem document states. Proxies answer with other content. */
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

/** The header `strew-columns`. */
const columnsOf = (response) => JSON.parse(response.headers.get("strew-columns"));

/** The header `strew-origin`. */
const originOf = (response, axes) => response.headers.get("strew-origin")?.split(",").map(Number) ?? axes.map(() => 0);

/** A query of a daemon. */
class RemotePlan {
    #daemon;
    #query;
    #dimension;
    #axes;
    #known;

    constructor(daemon, query, dimension) {
        this.#daemon = daemon;
        this.#dimension = dimension;
        this.#axes = [...dimension.axes];
        this.#query = { ...query };
        for (const name of OUTPUT) delete this.#query[name];
    }

    /** Forgets what is known of the answer. */
    free() {
        this.#known = undefined;
    }

    #points(more, form) {
        return this.#daemon.request(this.#dimension.queries, text({ ...this.#query, ...more }), form);
    }

    async #json(path, more = {}) {
        return parsed((await this.#daemon.request(path, text({ ...this.#query, ...more }))).content);
    }

    async count() {
        return (await this.#json(`${this.#dimension.root}/points:split?parts=1`)).count;
    }

    async resolved() {
        const isWindow = ["offset", "limit", "cursor"].some((name) => name in this.#query);
        if (!isWindow) return (await this.#json(`${this.#dimension.root}/count`)).query;
        // Windows are counted by `split`, which does not repeat the query: one point does.
        const { query } = await this.#json(this.#dimension.queries, { format: "json", limit: 1 });
        const { format, relative_to, limit, ...rest } = query;
        return "limit" in this.#query ? { ...rest, limit: this.#query.limit } : rest;
    }

    /** The columns and the origin, from the headers of an answer with one point at most. */
    async #requestHead() {
        const response = await this.#points({ format: "f64", limit: 1 }, "arrayBuffer");
        return { columns: columnsOf(response), origin: originOf(response, this.#axes) };
    }

    #head() {
        if (this.#known) return this.#known;
        const head = this.#requestHead();
        this.#known = head;
        // After a failure the next call requests it again.
        head.catch(() => {
            if (this.#known === head) this.#known = undefined;
        });
        return head;
    }

    async origin() {
        return (await this.#head()).origin;
    }

    /** The rows of an answer, all of them numbers. */
    async #rows(format, kind) {
        const response = await this.#points({ format }, "arrayBuffer");
        const columns = columnsOf(response);
        checkWhole(response, response.content.byteLength / (columns.length * kind.BYTES_PER_ELEMENT));
        return { columns, values: new kind(response.content), origin: originOf(response, this.#axes) };
    }

    async #places(format, kind) {
        const { columns, values, origin } = await this.#rows(format, kind);
        const [step, axes] = [columns.length, this.#axes.length];
        const one = (_, i) => values[Math.floor(i / axes) * step + (i % axes)];
        const at = step === axes ? values : kind.from({ length: (axes * values.length) / step }, one);
        return { at, origin };
    }

    async rows() {
        const { columns, values, origin } = await this.#rows("f32", Float32Array);
        const named = columns.filter((column) => column.names).map((column) => [column.name, column.names]);
        return { columns: columns.map(({ name }) => name), values, names: Object.fromEntries(named), origin };
    }

    async coordinates() {
        return (await this.#places("f64", Float64Array)).at;
    }

    offsets() {
        return this.#places("f32", Float32Array);
    }

    async columns() {
        // The numbers of JSON read back to the same bits.
        const form = { format: "ndjson", summary: false };
        const [{ columns }, response] = await Promise.all([this.#head(), this.#points(form)]);
        const lines = response.content.split("\n").slice(0, -1);
        checkWhole(response, lines.length);
        const points = JSON.parse(`[${lines.join()}]`);
        const ids = BigInt64Array.from(points.flatMap(({ id }) => id.split(":").map(BigInt)));
        const at = Float64Array.from(points.flatMap((point) => this.#axes.map((axis) => point[axis])));
        const further = columns.slice(this.#axes.length).map((column) => [column.name, valuesOf(column, points)]);
        return { ids, at, further: new Map(further) };
    }

    async split(parts) {
        const answer = await this.#json(`${this.#dimension.root}/points:split?parts=${encodeURIComponent(parts)}`);
        return answer.parts.map(({ query, count }) => ({ cursor: query.cursor, limit: count }));
    }

    async document(options) {
        return new Uint8Array((await this.#points(options, "arrayBuffer")).content);
    }
}

/** Refuses an answer of fewer or more points than its header states. */
function checkWhole({ url, headers }, rows) {
    const count = headers.get("strew-count");
    if (rows !== Number(count)) throw brokenOff(url, `${Math.floor(rows)} of ${count} points came`);
}

/** The values of a column: numbers, or indices of names. */
function valuesOf({ name, names, names_left_out }, points) {
    const values = points.map((point) => point[name] ?? null);
    if (!names && !names_left_out) return { names: null, values: Float64Array.from(values, (value) => value ?? NaN) };
    // Headers have no room for very many names. Then names are numbered in the order in which points first have them.
    const known = names ?? [...new Set(values.filter((value) => value !== null))];
    const places = new Map(known.map((text, place) => [text, place]));
    return { names: known, values: Int32Array.from(values, (value) => places.get(value) ?? -1) };
}

/** A daemon, or several with the same points, with the functions of what `open` returns; its answers are promises. */
export function connect(url, options = {}) {
    return new Daemon(url, options);
}
