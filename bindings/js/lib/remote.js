// Points that a daemon makes, over HTTP. Everything is a promise.

import { StrewError } from "./error.js";
import { Source } from "./points.js";

class Daemon extends Source {
    checksAtOnce = false;
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
        let problem;
        try {
            problem = JSON.parse(content);
        } catch {
            throw new StrewError(`HTTP ${response.status}: ${content.slice(0, 200)}`, `http-${response.status}`);
        }
        throw new StrewError(problem.detail, problem.type.split(":").at(-1), problem.errors ?? []);
    }

    async json(path, body) {
        return (await this.request(path, body)).json();
    }

    plan(text) {
        return new Asked(this, text);
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

/** A query of a daemon. */
class Asked {
    #daemon;
    #text;
    #whole;

    constructor(daemon, text) {
        this.#daemon = daemon;
        this.#text = text;
    }

    /** The body with further members, which may not be there yet. */
    #body(more) {
        const members = JSON.stringify(more).slice(1, -1);
        return this.#text === "{}" ? `{${members}}` : `${this.#text.slice(0, -1)},${members}}`;
    }

    #query(more) {
        return this.#daemon.request("/v1/points:query", this.#body(more));
    }

    async count() {
        return (await this.#daemon.json("/v1/points:split?parts=1", this.#text)).count;
    }

    async resolved() {
        const { query } = await this.#document();
        const { format, relative_to, ...rest } = query;
        return rest;
    }

    /** The whole answer in JSON, whose numbers read back to the same bits. */
    #document() {
        this.#whole ??= this.#query({ format: "json" }).then(async (response) => {
            const origin = response.headers.get("strew-origin")?.split(",").map(Number) ?? [0, 0];
            return { ...(await response.json()), origin };
        });
        return this.#whole;
    }

    async origin() {
        return (await this.#document()).origin;
    }

    async xy() {
        return (await this.columns()).xy;
    }

    async xyF32() {
        const response = await this.#query({ format: "f32" });
        const count = Number(response.headers.get("strew-count"));
        const origin = response.headers.get("strew-origin").split(",").map(Number);
        const values = new Float32Array(await response.arrayBuffer());
        const each = values.length / count;
        if (each === 2 || !count) return { xy: values, origin };
        return { xy: Float32Array.from({ length: 2 * count }, (_, i) => values[(i >> 1) * each + (i & 1)]), origin };
    }

    async columns() {
        const { points } = await this.#document();
        const ids = BigInt64Array.from(points.flatMap(({ id }) => id.split(":").map(BigInt)));
        const xy = Float64Array.from(points.flatMap(({ x, y }) => [x, y]));
        const names = new Set(points.flatMap((point) => Object.keys(point)));
        for (const own of ["id", "x", "y"]) names.delete(own);
        const further = [...names].map((name) => {
            const values = points.map((point) => point[name] ?? null);
            if (!values.some((value) => typeof value === "string")) {
                return [name, { names: null, values: Float64Array.from(values, (value) => value ?? NaN) }];
            }
            const known = [...new Set(values.filter((value) => value !== null))];
            return [name, { names: known, values: Int32Array.from(values, (value) => known.indexOf(value)) }];
        });
        return { ids, xy, further: new Map(further) };
    }

    async split(parts) {
        const answer = await this.#daemon.json(`/v1/points:split?parts=${encodeURIComponent(parts)}`, this.#text);
        return answer.parts.map(({ query, count }) => ({ cursor: query.cursor, limit: count }));
    }

    async document(options) {
        return new Uint8Array(await (await this.#query(options)).arrayBuffer());
    }
}

/** A daemon, with the functions of what `open` returns; its answers are promises. */
export function connect(url, { key } = {}) {
    return new Daemon(url, key);
}
