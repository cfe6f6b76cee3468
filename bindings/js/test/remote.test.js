// Sets of a daemon, or of several, whose answers fail: one request more where an address fails, errors that say so, and
// never a shorter set. Servers are stubs that answer as the test sets them.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { test } from "node:test";

import { Disconnected, connect } from "../lib/index.js";
import { daemon } from "./support.js";

// No server listens there.
const NOWHERE = "http://127.0.0.1:9";
const COUNTED = JSON.stringify({ count: 7 });

/** A server that answers as the test wants, and its requests. */
async function server(t, answer) {
    const requests = [];
    const made = createServer(async (request, response) => {
        let body = "";
        for await (const piece of request) body += piece;
        requests.push({ path: request.url, body: body && JSON.parse(body) });
        await answer(response, request, body);
    });
    await new Promise((ready) => made.listen(0, "127.0.0.1", ready));
    t.after(() => (made.close(), made.closeAllConnections()));
    return { url: `http://127.0.0.1:${made.address().port}`, requests };
}

const POINTS = { points: [{ id: "1:2", x: 0.5, y: 0.25, angle: 3 }] };
const LINES = POINTS.points.map((point) => `${JSON.stringify(point)}\n`).join("");
const COLUMNS = ["x", "y", "angle"].map((name) => ({ name, type: "f64" }));

/** A stub with one point, or with the answer `fail`; `isBare` answers lack a header. */
async function stub(t) {
    const state = {};
    const { url, requests } = await server(t, (response, _, body) => {
        if (!state.isBare) response.setHeader("strew-columns", JSON.stringify(COLUMNS));
        response.setHeader("strew-count", POINTS.points.length);
        const answer = body.includes("f64") ? new Uint8Array(8 * COLUMNS.length) : JSON.stringify(POINTS);
        if (!state.fail) return response.end(body.includes("ndjson") ? LINES : answer);
        response.writeHead(state.fail.status).end(state.fail.content);
    });
    const points = (more = {}) => connect(url).query({ region: { bbox: [0, 0, 1, 1] }, spacing: 1, ...more });
    return { state, requests, points };
}

const refusing = (t, status, content = "busy", headers = {}) =>
    server(t, (response) => response.writeHead(status, headers).end(content));

const count = (there) => there.points({ bbox: [0, 0, 1, 1], spacing: 1 }).count();

/** The waits between attempts, which take no time. */
function waits(t) {
    const found = [];
    const { setTimeout } = globalThis;
    t.mock.method(globalThis, "setTimeout", (work, time, ...more) => {
        // Node's own requests have timers too.
        if (!new Error().stack.includes("/lib/remote.js")) return setTimeout(work, time, ...more);
        found.push(time);
        return setTimeout(work, 0);
    });
    return found;
}

test("requests go on at the next address and stay there", async (t) => {
    const waited = waits(t);
    const good = await refusing(t, 200, COUNTED);
    const busy = await refusing(t, 503, "busy", { "retry-after": "2" });
    const there = connect([busy.url, NOWHERE, good.url]);
    const words = (error) => assert.match(error.message, RegExp(`^${busy.url}: HTTP 503: busy; ${NOWHERE}: [^;]+$`)) ?? true;
    await assert.rejects(count(there), (error) => error instanceof Disconnected && words(error));
    for (let i = 0; i < 5; i++) assert.equal(await count(there), 7);
    assert.deepEqual([busy.requests.length, waited], [1, [2000]]);
    assert.equal(await count(connect(`${NOWHERE},${good.url}`)), 7);
});

test("one address is tried twice", async (t) => {
    const waited = waits(t);
    const problem = JSON.stringify({ type: "urn:strew:problem:busy", detail: "later" });
    for (const [stated, wait] of [["0", 0], ["3", 3000], ["600", 5000], ["Sun, 06 Nov 2094 08:49:37 GMT", 5000]]) {
        const { url, requests } = await refusing(t, 503, problem, { "retry-after": stated });
        await assert.rejects(count(connect(url)), { name: "StrewError", kind: "busy", message: `${url}: later` });
        assert.deepEqual([requests.length, waited.pop()], [2, wait]);
    }
    await assert.rejects(count(connect(NOWHERE)), (error) => /^http:\/\/127.0.0.1:9: [^;]+$/.test(error.message));
});

test("refusals are not repeated", async (t) => {
    for (const status of [400, 401, 404, 409, 413, 429, 500, 502, 503, 504]) {
        const one = await refusing(t, status, "no", status === 503 ? {} : { "retry-after": "1" });
        const other = await refusing(t, 200, COUNTED);
        const error = { kind: `http-${status}`, message: `HTTP ${status}: no` };
        await assert.rejects(count(connect([one.url, other.url])), error);
        assert.deepEqual([one.requests.length, other.requests.length], [1, 0]);
    }
});

test("an answer that breaks off is an error", async (t) => {
    const running = await daemon();
    if (!running) return t.skip("the daemon is not built");
    t.after(running.end);
    const query = { bbox: [0, 0, 60, 60], spacing: 1, seed: 4, attributes: ["angle"] };
    for (const [share, more] of [[0, 0], [0.1, 0], [2 / 3, 0], [0.9999, 0], [1, 1], [1, -1]]) {
        const { url, requests } = await server(t, async (response, { url, method }, body) => {
            const headers = { "content-type": "application/json" };
            const whole = await fetch(running.url + url, method === "POST" ? { method, body, headers } : {});
            const content = Buffer.from(await whole.arrayBuffer());
            // The heads of answers come as they are: what they state is needed before rows are counted.
            const isHead = body.includes('"limit"');
            for (const name of ["strew-columns", "strew-count"]) response.setHeader(name, whole.headers.get(name) ?? "");
            if (!isHead) response.setHeader("strew-count", Number(whole.headers.get("strew-count")) + more);
            response.writeHead(200, { "content-length": content.length });
            const sent = isHead ? content.length : Math.floor(content.length * share);
            response.write(content.subarray(0, sent), () => (sent < content.length ? response.destroy() : response.end()));
        });
        const points = () => connect([url, running.url]).points(query);
        const readings = [() => points().xy(), () => points().rowsF32(), () => points().ids()];
        const further = [() => points().count(), () => points().document("csv"), () => points().nearest([3, 4])];
        for (const reading of more ? readings : [...readings, ...further]) {
            const words = (error) => error instanceof Disconnected && error.message.startsWith(`${url}: the answer broke off: `);
            const before = requests.length;
            await assert.rejects(reading(), (error) => words(error) || assert.fail(error));
            // No answer is begun again; `ids` needs a head beside it.
            assert.equal(requests.length - before, reading === readings[2] ? 2 : 1);
        }
    }
});

test("a killed daemon is left for the next address", async (t) => {
    const running = await Promise.all([daemon(), daemon()]);
    if (!running[0]) return t.skip("the daemon is not built");
    t.after(() => running[1].end());
    const there = connect(running.map(({ url }) => url));
    const xy = () => there.points({ bbox: [0, 0, 50, 50], spacing: 1, seed: 2 }).xy();
    const before = await xy();
    await running[0].kill();
    assert.deepEqual([await xy(), await xy()], [before, before]);
});

test("members of the form of an answer are replaced", async (t) => {
    const { points, requests } = await stub(t);
    await points({ format: "csv", decimals: 1, size: 9, summary: false, crs: "EPSG:32633" }).ids();
    assert.deepEqual(requests.map(({ body }) => Object.keys(body).sort()), [
        ["format", "limit", "region", "spacing"],
        ["format", "region", "spacing", "summary"],
    ]);
});

test("a request that failed is made again", async (t) => {
    const { points, state } = await stub(t);
    const set = points();
    state.fail = { status: 503, content: "busy" };
    for (const call of [() => set.ids(), () => set.origin()]) {
        await assert.rejects(call(), { kind: "http-503", message: "HTTP 503: busy" });
    }
    state.fail = undefined;
    assert.deepEqual(await set.ids(), new BigInt64Array([1n, 2n]));
    assert.deepEqual(await set.column("angle"), new Float64Array([3]));
    assert.deepEqual(await set.origin(), [0, 0]);
    set.free();
    assert.deepEqual(await set.names(), ["angle"]);
    state.isBare = true;
    await assert.rejects(points().names(), { name: "Disconnected", message: /the answer has no header strew-columns/ });
});

test("problems without a type, and what is no problem, are errors", async (t) => {
    const { points, state } = await stub(t);
    for (const [content, kind, message] of [
        ['{"detail":"wrong"}', "http-400", "wrong"],
        ['{"type":"urn:strew:problem:invalid-query","detail":"wrong"}', "invalid-query", "wrong"],
        ["null", "http-400", "HTTP 400: null"],
        ["<p>no</p>", "http-400", "HTTP 400: <p>no</p>"],
    ]) {
        state.fail = { status: 400, content };
        await assert.rejects(points().count(), { name: "StrewError", kind, message });
    }
});

test("a terrain and a field of JSON are both held", async (t) => {
    const { points, requests } = await stub(t);
    const ramp = { ramp: { from: [0, 0], to: [9, 0] } };
    await points({ field: ramp, terrain: ramp }).nearest([1, 1]);
    assert.deepEqual(requests.map(({ path }) => path.split("?")[0]), ["/v1/fields", "/v1/fields", "/v1/nearest"]);
});

test("a loop over a daemon's points is refused without a request", async (t) => {
    const { points, requests, state } = await stub(t);
    state.fail = { status: 500, content: "" };
    assert.throws(() => [...points()], /await points\.xy\(\)/);
    await new Promise((later) => setTimeout(later, 50));
    assert.deepEqual(requests, []);
});
