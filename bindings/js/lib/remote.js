// Points that a daemon makes, or one of several, over HTTP. Everything is a promise.
//
// A request goes to the address that answered last, and is sent once more to the next one. Nothing else is kept of
// addresses: balancing, health and longer retries are what proxies are for.

import { Disconnected, StrewError, fault } from "./error.js";
import { OUTPUT, WINDOW } from "./parameters.js";
import { Source } from "./points.js";
import { PLANE, address, parsed, text } from "./query.js";
/** @import { Backend, Body, Column, ColumnName, Dimension, Further, Kind, Offsets, Plan } from "./types.js" */
/** @import { SpacePoint } from "./index.js" */
/** @typedef {Awaited<ReturnType<Daemon["request"]>>} Got */
/** @typedef {{ name: ColumnName, names?: string[], names_left_out?: boolean }} Head What headers state of a column. */

// The longest wait for `Retry-After`, in seconds.
const PATIENCE = 5;

/** An address of HTTP, or in a page a path of its own server. */
function checkedAddress(/** @type {string} */ text) {
    if (/^https?:\/\/./i.test(text) || (globalThis.location && /^[./]/.test(text))) return text;
    const detail = /^[^/]*:\d+(\/|$)/.test(text) ? "http:// is missing" : "no address of a daemon";
    throw fault("url", text, detail, "http://host:port or https://host:port");
}

function addresses(/** @type {string | URL | (string | URL)[]} */ url) {
    const texts = String(url).split(",");
    return [...new Set(texts.map((text) => checkedAddress(text.trim()).replace(/\/+$/, "")))];
}

/** Node states the reason as the cause of an error. @type {(error: Error & { cause?: any }) => string} */
const why = ({ cause, message }) => cause?.message || cause?.code || message;

/** @implements {Backend<"there">} */
class Daemon {
    side = /** @type {const} */ ("there");
    #headers;
    #urls;
    // Which address the next request goes to.
    #place = 0;

    /** @param {string | URL | (string | URL)[]} url @param {{ key?: string }} options */
    constructor(url, { key }) {
        this.#headers = /** @type {Record<string, string>} */ (key ? { authorization: `Bearer ${key}` } : {});
        this.#urls = addresses(url);
    }

    /** A good response. A request without an answer is sent once more. @param {string} path @param {string} [body] */
    async request(path, body) {
        const post = { method: "POST", body, headers: { ...this.#headers, "content-type": "application/json" } };
        const options = body === undefined ? { headers: this.#headers } : post;
        /** @type {string[]} */
        const tried = [];
        for (;;) {
            const place = this.#place;
            const url = this.#urls[place];
            const response = await fetch(url + path, options).catch((error) => new Disconnected(why(error)));
            const isLost = response instanceof Disconnected;
            if (!isLost && response.ok) {
                const lost = (/** @type {Error} */ error) => Promise.reject(brokenOff(url, why(error)));
                return { url, headers: response.headers, content: await response.arrayBuffer().catch(lost) };
            }
            const error = isLost ? response : refusal(response.status, await response.text().catch(String));
            const wait = isLost ? "0" : response.headers.get("retry-after");
            if (wait === null || (!isLost && response.status !== 503)) throw error;
            this.#place = (place + 1) % this.#urls.length;
            tried.push(`${url}: ${error.message}`);
            if (tried.length === 2) {
                error.message = [...new Set(tried)].join("; ");
                throw error;
            }
            const seconds = /^\d+$/.test(wait) ? Math.min(Number(wait), PATIENCE) : PATIENCE;
            await new Promise((ready) => setTimeout(ready, 1000 * seconds));
        }
    }

    /** @param {string} path @param {string} [body] */
    async json(path, body) {
        return JSON.parse(textOf(await this.request(path, body)));
    }

    plan(/** @type {string} */ _, /** @type {Body} */ query, dimension = PLANE) {
        return new RemotePlan(this, query, dimension);
    }

    async nearest(/** @type {Body} */ values, /** @type {Dimension} */ { root }) {
        return (await this.json(`${root}/nearest?${address(values)}`)).neighbors;
    }

    async point(/** @type {string} */ id, /** @type {Body} */ values, /** @type {Dimension} */ { root }) {
        return (await this.json(`${root}/points/${encodeURIComponent(id)}?${address(values)}`)).point;
    }

    async holdField(/** @type {string} */ body) {
        return (await this.json("/v1/fields", body)).name;
    }
}

/** @type {(url: string, why: string) => Disconnected} */
const brokenOff = (url, why) => new Disconnected(`${url}: the answer broke off: ${why}`);

/** The error that a problem document states. Proxies answer with other content. */
function refusal(/** @type {number} */ status, /** @type {string} */ content) {
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

const textOf = (/** @type {Got} */ { content }) => new TextDecoder().decode(content);

/** The header `strew-columns`. Proxies may take it away. @type {(got: Got) => Head[]} */
function columnsOf({ url, headers }) {
    const columns = headers.get("strew-columns");
    if (columns === null) throw new Disconnected(`${url}: the answer has no header strew-columns`);
    return JSON.parse(columns);
}

/** The header `strew-origin`. @type {(got: Got, axes: string[]) => Offsets["origin"]} */
const originOf = ({ headers }, axes) => headers.get("strew-origin")?.split(",").map(Number) ?? axes.map(() => 0);

/** A query of a daemon. @implements {Plan<"there">} */
class RemotePlan {
    #daemon;
    #query;
    #dimension;
    #axes;
    /** @type {Promise<{ columns: Head[], origin: number[] }> | undefined} */
    #known;

    constructor(/** @type {Daemon} */ daemon, /** @type {Body} */ query, /** @type {Dimension} */ dimension) {
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

    #request(/** @type {Body} */ more, path = this.#dimension.queries) {
        return this.#daemon.request(path, text({ ...this.#query, ...more }));
    }

    async #json(/** @type {string} */ path, more = {}) {
        return parsed(textOf(await this.#request(more, path)));
    }

    async count() {
        return (await this.#json(`${this.#dimension.root}/points:split?parts=1`)).count;
    }

    async resolved() {
        const isWindow = WINDOW.some((name) => name in this.#query);
        if (!isWindow) return (await this.#json(`${this.#dimension.root}/count`)).query;
        // Windows are counted by `split`, which does not repeat the query: one point does.
        const { query } = await this.#json(this.#dimension.queries, { format: "json", limit: 1 });
        const { format, relative_to, limit, ...rest } = query;
        return "limit" in this.#query ? { ...rest, limit: this.#query.limit } : rest;
    }

    /** The columns and the origin, of an answer with one point at most. */
    #head() {
        const head = (this.#known ??= this.#rows({ format: "f64", limit: 1 }, Float64Array));
        // After a failure the next call requests it again.
        head.catch(() => (this.#known = this.#known === head ? undefined : this.#known));
        return head;
    }

    async origin() {
        return (await this.#head()).origin;
    }

    /** The rows of an answer, all of them numbers. @template Made @param {Body} form @param {Kind<Made>} kind */
    async #rows(form, kind) {
        const response = await this.#request(form);
        const columns = columnsOf(response);
        checkWhole(response, response.content.byteLength / (columns.length * kind.BYTES_PER_ELEMENT));
        return { columns, values: new kind(response.content), origin: originOf(response, this.#axes) };
    }

    /** @template {Float32Array | Float64Array} Made @param {string} format @param {Kind<Made>} kind */
    async #places(format, kind) {
        const { columns, values, origin } = await this.#rows({ format }, kind);
        const [step, axes] = [columns.length, this.#axes.length];
        if (step === axes) return { at: values, origin };
        return { at: /** @type {Made} */ (values.filter((_, i) => i % step < axes)), origin };
    }

    async rows() {
        const { columns, values, origin } = await this.#rows({ format: "f32" }, Float32Array);
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
        const [{ columns }, response] = await Promise.all([this.#head(), this.#request(form)]);
        const lines = textOf(response).split("\n").slice(0, -1);
        checkWhole(response, lines.length);
        /** @type {SpacePoint[]} */
        const points = JSON.parse(`[${lines.join()}]`);
        const ids = BigInt64Array.from(points.flatMap(({ id }) => id.split(":").map(BigInt)));
        const at = Float64Array.from(points.flatMap((point) => this.#axes.map((axis) => point[axis])));
        /** @type {Further} */
        const further = new Map();
        for (const column of columns.slice(this.#axes.length)) further.set(column.name, valuesOf(column, points));
        return { ids, at, further };
    }

    async split(/** @type {number} */ parts) {
        const answer = await this.#json(`${this.#dimension.root}/points:split?parts=${encodeURIComponent(parts)}`);
        /** @type {{ query: { cursor: string }, count: number }[]} */
        const places = answer.parts;
        return places.map(({ query, count }) => ({ cursor: query.cursor, limit: count }));
    }

    async document(/** @type {Body} */ options) {
        return new Uint8Array((await this.#request(options)).content);
    }
}

/** Refuses an answer of fewer or more points than its header states. */
function checkWhole(/** @type {Got} */ { url, headers }, /** @type {number} */ rows) {
    const count = headers.get("strew-count");
    if (rows !== Number(count)) throw brokenOff(url, `${Math.floor(rows)} of ${count} points came`);
}

/** The values of a column of points as JSON has them: any. @type {(head: Head, points: any[]) => Column} */
function valuesOf({ name, names, names_left_out }, points) {
    const values = points.map((point) => point[name] ?? null);
    if (!names && !names_left_out) return { names: null, values: Float64Array.from(values, (value) => value ?? NaN) };
    // Headers have no room for very many names. Then names are numbered in the order in which points first have them.
    const known = names ?? [...new Set(values.filter((value) => value !== null))];
    const places = new Map(known.map((text, place) => [text, place]));
    return { names: known, values: Int32Array.from(values, (value) => places.get(value) ?? -1) };
}

/** @type {typeof import("./index.js").connect} */
export const connect = (url, options = {}) => new Source(new Daemon(url, options));
