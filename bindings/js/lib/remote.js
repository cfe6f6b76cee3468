// Points that a daemon makes, or one of several, over HTTP. Everything is a promise.

import { StrewError, fault } from "./error.js";
import { OUTPUT } from "./parameters.js";
import { Source } from "./points.js";
import { PLANE, address, parsed, text } from "./query.js";
import { Elsewhere, Later, Replicas, broken, retryAfter } from "./replicas.js";

// The statuses of refusals that pass: the same request may succeed later.
const LATER = [429, 502, 503, 504];
// Refusals that depend on the tables, fields and worlds of a daemon: their kinds, or the members at fault.
const HELD_KINDS = ["other-table", "other-world"];
const HELD = ["cursor", "except", "field", "profile", "table", "terrain", "world"];

/** An address of HTTP, or in a page a path of its own server. */
function checkedAddress(text) {
    if (/^https?:\/\/./i.test(text) || (globalThis.location && /^[./]/.test(text))) return text;
    const detail = /^[^/]*:\d+(\/|$)/.test(text) ? "http:// is missing" : "no address of a daemon";
    throw fault("url", text, detail, "http://host:port or https://host:port");
}

function addresses(url) {
    const texts = Array.isArray(url) ? url : String(url).split(",");
    return [...new Set(texts.map((text) => checkedAddress(String(text).trim()).replace(/\/+$/, "")))];
}

class Daemon extends Source {
    #headers;
    #replicas;

    constructor(url, { key, retries = 3, patience = 30 }) {
        super();
        this.#headers = key ? { authorization: `Bearer ${key}` } : {};
        this.#replicas = new Replicas(addresses(url), retries, patience);
    }

    /** The response of a replica, if it succeeded. */
    async #call(replica, path, body) {
        const post = { method: "POST", body, headers: { ...this.#headers, "content-type": "application/json" } };
        const options = body === undefined ? { headers: this.#headers } : post;
        const lost = (error) => Promise.reject(broken(replica, error));
        const response = await fetch(replica.url + path, options).catch(lost);
        if (response.ok) {
            replica.answered();
            return response;
        }
        const error = refusal(response.status, await response.text().catch(lost));
        if (LATER.includes(response.status)) throw new Later(error, retryAfter(response.headers.get("retry-after")));
        replica.answered();
        throw isAboutHeld(error) ? new Elsewhere(error) : error;
    }

    /** Calls `work(call, progress)` at one replica after another. For a broken body it throws `call.broken(error)`. */
    attempts(work, limits) {
        const attempt = (replica, progress) => {
            const call = (path, body) => this.#call(replica, path, body);
            call.broken = (error) => broken(replica, error);
            return work(call, progress);
        };
        return this.#replicas.attempts(attempt, limits);
    }

    /** The response to a request, with its whole content. */
    request(path, body, limits) {
        return this.attempts(async (call) => {
            const response = await call(path, body);
            const content = await response.arrayBuffer().catch((error) => Promise.reject(call.broken(error)));
            return new Response(content, { headers: response.headers });
        }, limits);
    }

    async json(path, body) {
        return (await this.request(path, body)).json();
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

    /** Sends a field to all daemons that can be reached: its name is a digest, and any may be called next. */
    async holdField(body) {
        const up = this.#replicas.all.length > 1 ? this.#replicas.up() : [];
        const one = (replica) => this.request("/v1/fields", body, { only: [replica], retries: 0 });
        const sent = await Promise.allSettled(up.map(one));
        const held = sent.find(({ status }) => status === "fulfilled")?.value;
        return (await (held ?? (await this.request("/v1/fields", body))).json()).name;
    }
}

const isAboutHeld = ({ kind, faults }) => {
    const members = faults.map(({ field }) => String(field).split(".").at(-1));
    return HELD_KINDS.includes(kind) || (members.length > 0 && members.every((member) => HELD.includes(member)));
};

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

    #points(more) {
        return this.#daemon.request(this.#dimension.queries, text({ ...this.#query, ...more }));
    }

    async #json(path, more = {}) {
        return parsed(await (await this.#daemon.request(path, text({ ...this.#query, ...more }))).text());
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
        const response = await this.#points({ format: "f64", limit: 1 });
        await response.arrayBuffer();
        return { columns: JSON.parse(response.headers.get("strew-columns")), origin: originOf(response, this.#axes) };
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
        const columns = ({ headers }) => JSON.parse(headers.get("strew-columns"));
        const whole = (bytes, response) => {
            const each = columns(response).length * kind.BYTES_PER_ELEMENT;
            const rows = Math.floor(bytes.length / each);
            return { rows, length: rows * each };
        };
        const { bytes, first } = await new Answer(this.#daemon, this.#dimension, this.#query, { format }, whole).read();
        return { columns: columns(first), values: new kind(bytes.buffer), origin: originOf(first, this.#axes) };
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
        const lines = new Answer(this.#daemon, this.#dimension, this.#query, form, wholeLines);
        const [{ columns }, { bytes }] = await Promise.all([this.#head(), lines.read()]);
        const points = JSON.parse(`[${new TextDecoder().decode(bytes).trimEnd().replaceAll("\n", ",")}]`);
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
        return new Uint8Array(await (await this.#points(options)).arrayBuffer());
    }
}

/** The whole lines among the first bytes of an answer of lines. */
function wholeLines(bytes) {
    const newline = 10;
    let rows = 0;
    for (const byte of bytes) rows += byte === newline;
    return { rows, length: bytes.lastIndexOf(newline) + 1 };
}

/** The bytes of a body, until it ends or breaks off, and the error if it broke off. */
async function received(response) {
    const chunks = [];
    let error;
    try {
        const reader = response.body.getReader();
        for (let part; !(part = await reader.read()).done; ) chunks.push(part.value);
    } catch (reason) {
        error = reason;
    }
    return { bytes: joined(chunks), error };
}

function joined(chunks) {
    const bytes = new Uint8Array(chunks.reduce((length, chunk) => length + chunk.length, 0));
    let at = 0;
    for (const chunk of chunks) {
        bytes.set(chunk, at);
        at += chunk.length;
    }
    return bytes;
}

/** The bytes of an answer of rows. After a break it resumes behind the last whole row, at any replica. */
class Answer {
    #daemon;
    #path;
    #query;
    #whole;
    #parts = [];
    #rows = 0;
    #count;
    #cursor = null;
    #first;

    /** `whole(bytes, response)` returns the number of whole `rows` at the start of some bytes, and their `length`. */
    constructor(daemon, dimension, query, form, whole) {
        this.#daemon = daemon;
        this.#path = dimension.queries;
        this.#query = { ...query, ...form };
        this.#whole = whole;
    }

    /** All bytes, and the first response for its headers. */
    async read() {
        try {
            await this.#daemon.attempts((call, progress) => this.#attempt(call, progress));
        } catch (error) {
            if (!this.#rows || !(error instanceof StrewError)) throw error;
            const came = `${this.#rows} of ${this.#count} points came, and no other daemon continues`;
            throw new StrewError(`${came}: ${error.message}`, error.kind, error.faults);
        }
        return { bytes: joined(this.#parts), first: this.#first };
    }

    async #attempt(call, progress) {
        if (this.#cursor === null) {
            // Short answers have no cursor: they begin again.
            this.#parts = [];
            this.#rows = 0;
        }
        const response = await call(this.#path, text(this.#rest()));
        const count = Number(response.headers.get("strew-count"));
        if (!this.#rows) {
            this.#count = count;
            this.#cursor = response.headers.get("strew-cursor");
            this.#first = response;
        } else if (this.#rows + count !== this.#count) {
            throw new StrewError(`the answer goes on with ${count} points`, "other-answer");
        }
        const { bytes, error } = await received(response);
        const { rows, length } = this.#whole(bytes, response);
        this.#parts.push(bytes.subarray(0, length));
        this.#rows += rows;
        if (rows && this.#cursor !== null) progress();
        if (this.#rows === this.#count) return;
        throw call.broken(error ?? new Error(`${this.#rows} of ${this.#count} points came`));
    }

    /** The query of the remaining rows. The order of points is fixed, so an offset finds them. */
    #rest() {
        if (!this.#rows) return this.#query;
        const rest = { ...this.#query, cursor: this.#cursor, offset: this.#rows };
        if ("limit" in rest) rest.limit = Number(rest.limit) - this.#rows;
        return rest;
    }
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
