// Sets of a daemon whose answers fail. The server is a stub that answers as the test sets it.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { after, before, beforeEach, test } from "node:test";

import { connect } from "../lib/index.js";

const POINTS = { points: [{ id: "1:2", x: 0.5, y: 0.25, angle: 3 }] };
const LINES = POINTS.points.map((point) => `${JSON.stringify(point)}\n`).join("");
const COLUMNS = ["x", "y", "angle"].map((name) => ({ name, type: "f64" }));

let server;
let url;
let requests;
let fail;
before(async () => {
    server = createServer(async (request, response) => {
        let body = "";
        for await (const piece of request) body += piece;
        requests.push({ path: request.url, body: body && JSON.parse(body) });
        response.setHeader("strew-columns", JSON.stringify(COLUMNS));
        response.setHeader("strew-count", POINTS.points.length);
        if (!fail) return response.end(body.includes("ndjson") ? LINES : JSON.stringify(POINTS));
        response.writeHead(fail.status).end(fail.content);
    });
    await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
    url = `http://127.0.0.1:${server.address().port}`;
});
after(() => server.close());
beforeEach(() => {
    requests = [];
    fail = undefined;
});

const points = (more = {}) => connect(url).query({ region: { bbox: [0, 0, 1, 1] }, spacing: 1, ...more });

test("members of the form of an answer are replaced", async () => {
    await points({ format: "csv", decimals: 1, size: 9, summary: false, crs: "EPSG:32633" }).ids();
    assert.deepEqual(requests.map(({ body }) => Object.keys(body).sort()), [
        ["format", "limit", "region", "spacing"],
        ["format", "region", "spacing", "summary"],
    ]);
});

test("a request that failed is made again", async () => {
    const set = points();
    fail = { status: 503, content: "busy" };
    for (const call of [() => set.ids(), () => set.origin()]) {
        await assert.rejects(call(), { kind: "http-503", message: "HTTP 503: busy" });
    }
    fail = undefined;
    assert.deepEqual(await set.ids(), new BigInt64Array([1n, 2n]));
    assert.deepEqual(await set.column("angle"), new Float64Array([3]));
    assert.deepEqual(await set.origin(), [0, 0]);
    set.free();
    assert.deepEqual(await set.names(), ["angle"]);
});

test("problems without a type, and what is no problem, are errors", async () => {
    for (const [content, kind, message] of [
        ['{"detail":"wrong"}', "http-400", "wrong"],
        ['{"type":"urn:strew:problem:invalid-query","detail":"wrong"}', "invalid-query", "wrong"],
        ["null", "http-400", "HTTP 400: null"],
        ["<p>no</p>", "http-400", "HTTP 400: <p>no</p>"],
    ]) {
        fail = { status: 400, content };
        await assert.rejects(points().count(), { name: "StrewError", kind, message });
    }
});

test("a terrain and a field of JSON are both held", async () => {
    const ramp = { ramp: { from: [0, 0], to: [9, 0] } };
    await points({ field: ramp, terrain: ramp }).nearest([1, 1]);
    assert.deepEqual(requests.map(({ path }) => path.split("?")[0]), ["/v1/fields", "/v1/fields", "/v1/nearest"]);
});

test("a loop over a daemon's points is refused without a request", async () => {
    fail = { status: 500, content: "" };
    assert.throws(() => [...points()], /await points\.xy\(\)/);
    await new Promise((later) => setTimeout(later, 50));
    assert.deepEqual(requests, []);
});
