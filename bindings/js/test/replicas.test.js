// One client of several daemons: they are killed, busy or wrong, and every point comes once.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { test } from "node:test";

import { Disconnected, connect } from "../lib/index.js";
import { retryAfter } from "../lib/replicas.js";
import { daemon, whole } from "./support.js";

const [READERS, KILLS] = [32, 2];
const bytes = (array) => Buffer.from(array.buffer, array.byteOffset, array.byteLength);

test("readers of killed replicas get every point once", async (t) => {
    const running = await Promise.all([daemon(), daemon(), daemon()]);
    if (!running[0]) return t.skip("the daemon is not built");
    const continued = [];
    const { fetch } = globalThis;
    t.mock.method(globalThis, "fetch", (url, options) => {
        const { cursor, offset } = JSON.parse(options.body);
        if (cursor) continued.push(offset);
        return fetch(url, options);
    });
    const query = { bbox: [0, 0, 120, 120], spacing: 1, seed: 3, attributes: ["angle"] };
    const here = (await whole()).points(query);
    const there = connect(running.map(({ url }) => url));
    let [answers, isOver] = [0, false];
    t.after(() => {
        isOver = true;
        for (const { end } of running) end();
    });
    const read = async (number) => {
        do {
            const points = there.points(query);
            if (number % 4) assert.ok(bytes(await points.xy()).equals(bytes(here.xy())));
            else assert.ok(bytes(await points.ids()).equals(bytes(here.ids())));
            answers += 1;
        } while (!isOver);
    };
    const readers = Promise.all(Array.from({ length: READERS }, (_, number) => read(number)));
    for (let kill = 0; kill < KILLS; kill++) {
        const before = answers;
        while (answers < before + 2) await Promise.race([readers, new Promise((next) => setImmediate(next))]);
        const [victim] = running.splice(0, 1);
        await victim.kill();
        running.push(await daemon(victim.url.replace("http://", "")));
    }
    isOver = true;
    await readers;
    assert.ok(continued.length && Math.min(...continued) > 0);
});

/** A server of one answer, and how often it was called. */
async function server(answer) {
    const calls = { number: 0 };
    const made = createServer((request, response) => {
        calls.number += 1;
        request.resume().on("end", () => answer(response));
    });
    await new Promise((ready) => made.listen(0, "127.0.0.1", ready));
    return { url: `http://127.0.0.1:${made.address().port}`, calls, end: () => made.close() };
}

const COUNTED = JSON.stringify({ count: 7 });
const refusing = (status, content, headers) => server((response) => response.writeHead(status, headers).end(content));
const count = (urls, options) => connect(urls, options).points({ bbox: [0, 0, 1, 1], spacing: 1 }).count();

test("what may succeed elsewhere is tried there, and a busy daemon rests", async () => {
    const good = await server((response) => response.end(COUNTED));
    const busy = await refusing(503, "busy", { "retry-after": "600" });
    const there = connect(`${busy.url},${good.url}`).points({ bbox: [0, 0, 1, 1], spacing: 1 });
    for (let i = 0; i < 5; i++) assert.equal(await there.count(), 7);
    assert.equal(busy.calls.number, 1);
    await assert.rejects(count(busy.url), { kind: "http-503" });
    for (const problem of [
        { type: "urn:strew:problem:other-world", detail: "other" },
        { type: "urn:strew:problem:invalid-query", detail: "other", errors: [{ field: "layers[0].field" }] },
    ]) {
        const other = await refusing(409, JSON.stringify(problem));
        assert.equal(await count([other.url, good.url]), 7);
        await assert.rejects(count([other.url, `${other.url}/x`]), { message: "other" });
        assert.equal(other.calls.number, 3);
        other.end();
    }
    good.end();
    busy.end();
});

test("refusals of a query are not repeated, and attempts are bounded", async () => {
    const problem = { type: "urn:strew:problem:invalid-query", detail: "no", errors: [{ field: "spacing" }] };
    const wrong = await refusing(400, JSON.stringify(problem));
    await assert.rejects(count([wrong.url, `${wrong.url}/x`]), { message: "no" });
    assert.equal(wrong.calls.number, 1);
    const down = await refusing(502, "");
    await assert.rejects(count([down.url, `${down.url}/x`], { retries: 2 }), { kind: "http-502" });
    assert.equal(down.calls.number, 6);
    await assert.rejects(count(down.url, { retries: 1000, patience: 0.2 }), { kind: "http-502" });
    wrong.end();
    down.end();
    await assert.rejects(count("http://127.0.0.1:9", { retries: 0 }), Disconnected);
    assert.deepEqual([retryAfter("2"), retryAfter(null), retryAfter("soon")], [2000, 0, 0]);
    assert.ok(retryAfter(new Date(Date.now() + 60_000).toUTCString()) > 50_000);
});
