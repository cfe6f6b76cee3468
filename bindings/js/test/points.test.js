// The package without a daemon.
import assert from "node:assert/strict";
import { test } from "node:test";

import { DEFAULT_TABLES, SPACE_TABLES, StrewError, connect, open, raster } from "../lib/index.js";
import { open as openLite } from "../lib/lite.js";
import { Module } from "../lib/module.js";
import { body, parsed, text } from "../lib/query.js";

const strew = await open();

test("points, ids and columns", () => {
    const attributes = { attributes: "angle, variant", variants: { oak: 3, birch: 1 } };
    const points = strew.points({ bbox: [0, 0, 10, 10], spacing: 1, seed: 7, ...attributes });
    assert.equal(points.count(), 100);
    assert.equal(points.xy().length, 200);
    assert.equal(points.ids().length, 200);
    assert.deepEqual(points.names(), ["angle", "variant"]);
    assert.equal(points.column("angle").length, 100);
    assert.deepEqual([...new Set(points.column("variant"))].sort(), ["birch", "oak"]);
    const [first] = points;
    assert.equal(first.x, points.xy()[0]);
    assert.throws(() => points.column("size"), /no column "size"; there are x, y, angle, variant/);
    assert.throws(() => points.codes("angle"), RangeError);
    const { xy, origin } = points.xyF32();
    assert.deepEqual(origin, [0, 0]);
    assert.equal(xy[0], Math.fround(first.x));
});

test("a set without a region has chunks, neighbors and points by id", () => {
    const forest = strew.points({ spacing: 2, seed: 2n ** 64n - 1n });
    const chunk = forest.chunk(64, -3, 2);
    assert.deepEqual(chunk.origin(), [-192, 128]);
    assert.ok(chunk.xy().every((v) => v >= 0 && v < 64));
    const [near, next] = forest.nearest([100, -3], { k: 2 });
    assert.ok(near.distance < next.distance);
    assert.equal(forest.point(near.id).x, near.x);
    assert.throws(() => forest.point("1:x"), TypeError);
    assert.throws(() => forest.point("1:1"), { kind: "no-such-point" });
});

test("the tables by name have points in space", async () => {
    const own = await open({ tables: [...DEFAULT_TABLES, ...SPACE_TABLES] });
    const stars = own.space.points({ spacing: 2, seed: 5, attributes: "rotation" });
    const chunk = stars.chunk(16, -3, 2, 1);
    const { xyz, origin } = chunk.xyzF32();
    assert.ok(xyz instanceof Float32Array && xyz.every((v) => v >= 0 && v < 16));
    assert.deepEqual([origin, chunk.origin()], [[-48, 32, 16], [-48, 32, 16]]);
    assert.deepEqual(chunk.names(), ["qx", "qy", "qz", "qw"]);
    assert.equal(xyz.length, 3 * chunk.count());
    const [first] = chunk;
    assert.deepEqual([first.id, first.z], [[...chunk.ids().slice(0, 3)].join(":"), chunk.xyz()[2]]);
    assert.deepEqual([...chunk.column("z")].slice(0, 3), [2, 5, 8].map((i) => chunk.xyz()[i]));
    const [near] = stars.nearest([100, -3, 12]);
    assert.equal(stars.point(near.id).z, near.z);
    assert.throws(() => stars.point("1:2"), /three integers/);
    assert.throws(() => stars.within({}), /bbox, ball, prism, chunk/);
    assert.throws(() => own.space.points({ circle: [0, 0, 1], spacing: 1 }), { kind: "invalid-query" });
    const prism = own.space.points({ prism: [[[0, 0], [9, 0], [0, 9]], 1, 4], spacing: 1 });
    assert.ok(prism.column("z").every((z) => z >= 1 && z < 4));
});

test("parts are the whole, and their bodies are queries", () => {
    const points = strew.points({ bbox: [0, 0, 50, 50], spacing: 1, seed: 2 });
    const parts = points.split(3).map((part) => strew.query(structuredClone(part.body)));
    assert.deepEqual(parts.map((part) => part.count()), [833, 832, 832]);
    assert.deepEqual(parts.flatMap((part) => [...part.xy()]), [...points.xy()]);
});

test("counts of any size are exact", () => {
    assert.equal(strew.points({ bbox: [-5e8, -5e8, 5e8, 5e8], spacing: 1 }).count(), 1000000000097677487n);
    for (const many of [[0, 0, 1e6, 1e6], [0, 0, 3e4, 3e4]].map((bbox) => strew.points({ bbox, spacing: 1 }))) {
        for (const call of ["xy", "xyF32", "ids"]) {
            assert.throws(() => many[call](), (error) => {
                assert.match(error.message, /\d+ points, and an array has room for at most 268435455: .* chunks/);
                return error.kind === "too-many-points";
            });
        }
    }
    const document = () => strew.points({ bbox: [0, 0, 1e6, 1e6], spacing: 1 }).document("f64");
    assert.throws(document, /and this process returns at most \d+ in one answer/);
});

test("fields of arrays thin out", () => {
    const mask = new Uint8Array(64).map((_, i) => (i % 8 < 4 ? 0 : 255));
    const field = raster(mask, 8, 8, { bbox: [0, 0, 8, 8], filter: "nearest" });
    const points = strew.points({ bbox: [0, 0, 8, 8], spacing: 0.2, field });
    assert.ok(points.count() > 100 && points.column("x").every((x) => x >= 4));
    const [near] = points.nearest([1, 1]);
    assert.ok(near.x >= 4);
});

test("what is wrong has the words of REST", () => {
    const wrong = () => strew.points({ bbox: [0, 0, 10, 10], spacing: -1 });
    assert.throws(wrong, (error) => {
        assert.ok(error instanceof StrewError);
        assert.equal(error.message, "`spacing` = `-1`: out of range; allowed: a number from 1e-100 to 1e100");
        assert.equal(error.kind, "invalid-query");
        assert.deepEqual(error.faults.map(({ field }) => field), ["spacing"]);
        return true;
    });
    assert.throws(() => strew.points({ spacing: NaN }).nearest([0, 0]), StrewError);
    for (const [odd, name] of [
        [{ spacing: NaN }, "spacing"], [{ spacing: 1, seed: Infinity }, "seed"], [{ spacing: 1, foo: null }, "foo"],
        [{ spacing: 1, foo: () => 1 }, "foo"], [{ spacing: 1, foo: Symbol("x") }, "foo"],
        [{ spacing: 1, keep: Symbol("x") }, "keep"],
    ]) {
        assert.throws(() => strew.points({ bbox: [0, 0, 9, 9], ...odd }), (error) => {
            assert.match(error.message, /allowed: /);
            assert.deepEqual([error.kind, error.faults.map(({ field }) => field)], ["invalid-query", [name]]);
            return true;
        });
    }
    assert.throws(() => strew.points({ bbox: [0, 0, 1, NaN], spacing: 1 }), /region.bbox/);
    assert.throws(() => strew.points({ polygon: [null], spacing: 1 }), /region.polygon/);
});

test("what is no query or no address says so", () => {
    for (const wrong of [null, undefined, 7, [1]]) {
        for (const call of [() => strew.points(wrong), () => strew.query(wrong), () => strew.space.points(wrong)]) {
            assert.throws(call, /`query` = .*: not an object; allowed: such as \{ bbox/);
        }
    }
    const forest = strew.points({ spacing: 1 });
    for (const [wrong, words] of [[5, /`limits` = `5`/], [null, /`limits` = `null`/], [{ kk: 3 }, /`kk` = `3`/]]) {
        assert.throws(() => forest.nearest([1, 2], wrong), words);
    }
    assert.throws(() => forest.nearest(), /`at`: missing/);
    assert.throws(() => connect("127.0.0.1:8080"), /`url` = `127.0.0.1:8080`: http:\/\/ is missing; allowed: http/);
    assert.throws(() => connect(["http://localhost:1", "ftp://localhost"]), /`url` = `ftp:.*: no address of a daemon/);
});

test("kinds that are evenly spread are made, and those of a table that is not loaded name its file", () => {
    const query = { bbox: [0, 0, 9, 9], spacing: 2, variants: { birch: 1, oak: 3 }, attributes: "variant" };
    const kinds = strew.points({ ...query, spread: "even" }).column("variant");
    assert.equal(kinds.filter((name) => name === "oak").length, Math.round(0.75 * kinds.length));
    assert.throws(() => strew.points({ ...query, spread: "joint" }), /load its file beside the others.*strew-tables/);
    assert.throws(() => strew.points({ ...query, map: "s" }), /load its file beside the others.*strew-tables/);
    assert.throws(() => strew.points({ ...query, profile: "green" }), /load its file.*open\(\{ tables: \[/);
});

test("a module without the default table says what is loaded", async () => {
    const small = await open({ tables: ["blue-5-sqrt3-over-2-s.strew"] });
    assert.ok(small.points({ bbox: [0, 0, 9, 9], spacing: 1, map: "s" }).count() > 70);
    const words = /`map`: missing, and the query means map m, which is not loaded; load its file.*; allowed: s$/;
    assert.throws(() => small.points({ bbox: [0, 0, 9, 9], spacing: 1 }), words);
    await assert.rejects(open({ tables: [new Uint8Array(9)] }), StrewError);
    await assert.rejects(open({ tables: ["pink.strew"] }), /no table "pink.strew".* the package strew-tables/);
});

test("a file that is not where the code is says so, with the way out", async (t) => {
    const page = "<!doctype html><title>a page</title>";
    const answers = { html: [page, { headers: { "content-type": "text/html" } }], other: [page, {}], none: ["", { status: 404 }] };
    t.mock.method(globalThis, "fetch", async (url) => new Response(...answers[new URL(url).hostname]));
    for (const [name, words] of [["html", /an HTML page/], ["other", /no WebAssembly module/], ["none", /HTTP 404/]]) {
        await assert.rejects(open({ wasm: `http://${name}/strew.wasm` }), (error) => {
            assert.match(error.message, words);
            assert.match(error.message, /serve it there, pass its URL or its bytes as `open\(\{ wasm: … \}\)`/);
            return error instanceof StrewError;
        });
    }
    await assert.rejects(open({ tables: [new URL("./none.strew", import.meta.url)] }), /no such file.*open\(\{ tables: /);
});

test("a table of the other package", async () => {
    const { default: green } = await import("../tables/files/green-5-sqrt3-over-2-s.js");
    const strew = await open({ tables: [green] });
    assert.equal(strew.points({ bbox: [0, 0, 9, 9], spacing: 1, profile: "green" }).resolved().profile, "green");
});

test("terrains of JSON have neighbors and points by id", () => {
    const ramp = { ramp: { from: [0, 0], to: [10, 0] } };
    const points = strew.points({ bbox: [0, 0, 9, 9], count: 50, field: ramp, terrain: ramp, heights: [100, 200] });
    const [near] = points.nearest([8, 4]);
    assert.ok(Math.abs(near.z - (100 + 10 * near.x)) < 1e-9);
    assert.equal(points.point(near.id).z, near.z);
});

test("integers of any size are exact", () => {
    const points = strew.points({ bbox: [-5e8, -5e8, 5e8, 5e8], spacing: 1, seed: 2n ** 63n + 1n, warp: "off" });
    assert.equal(points.resolved().seed, 2n ** 63n + 1n);
    const parts = points.split(3);
    assert.equal(parts.reduce((sum, { body }) => sum + BigInt(body.limit), 0n), points.count());
    const [long, exact] = ["9007199254740993", 9007199254740993n];
    const value = parsed(`{"a":"${long}","seed":"${long}","kinds":{"b":"${long}"},"count":7}`);
    assert.deepEqual(value, { a: long, seed: exact, kinds: { b: exact }, count: 7 });
});

test("a set that is freed makes its points again", () => {
    const points = strew.points({ bbox: [0, 0, 10, 10], spacing: 1, seed: 3, attributes: ["angle"] });
    const [plan, xy, angles] = [points.plan(), points.xy(), points.column("angle")];
    points.free();
    points.free();
    assert.throws(() => plan.count(), { kind: "invalid-argument" });
    assert.deepEqual([points.xy(), points.column("angle")], [xy, angles]);
    if (Symbol.dispose) points[Symbol.dispose]();
});

test("memory does not grow when sets are freed", async (t) => {
    const instantiate = t.mock.method(WebAssembly, "instantiate");
    const own = await open();
    const { memory } = (await instantiate.mock.calls[0].result).exports;
    // A megabyte of columns each.
    const made = () => {
        const points = own.points({ bbox: [0, 0, 200, 200], spacing: 1, seed: 3, attributes: ["angle"] });
        points.column("angle");
        return points;
    };
    const held = [made()];
    held[0].free();
    const before = memory.buffer.byteLength;
    for (let i = 0; i < 50; i++) {
        held.push(made());
        held.at(-1).free();
    }
    assert.equal(memory.buffer.byteLength, before);
});

for (const [name, opened] of [["the package", open], ["strew/lite", openLite]]) {
    test(`memory of ${name} stays flat in a loop that frees nothing, and all sets keep their points`, async (t) => {
        const instantiate = t.mock.method(WebAssembly, "instantiate");
        const map = name === "strew/lite" ? "s" : "m";
        const forest = (await opened()).points({ map, spacing: 2, attributes: "angle" });
        const { memory } = (await instantiate.mock.calls[0].result).exports;
        const chunks = [];
        const make = (count) => {
            for (let i = 0; i < count; i++) {
                chunks.push(forest.chunk(32, i, 0));
                chunks.at(-1).column("angle");
            }
            return memory.buffer.byteLength;
        };
        const before = make(1500);
        const after = make(2500);
        assert.ok(after < 1.1 * before, `${before} and ${after} bytes`);
        assert.deepEqual(chunks[0].within({ chunk: [32, 0, 0] }).xy(), chunks[0].xy());
        assert.equal(chunks[0].count(), chunks[0].xy().length / 2);
    });
}

test("pointers above 2 GiB are read", () => {
    const memory = new WebAssembly.Memory({ initial: 2 ** 15 + 1 });
    const high = 2 ** 31 + 8;
    const text = '{"kind":"invalid-query","detail":"no","errors":[]}';
    new Uint8Array(memory.buffer, high + 64).set(new TextEncoder().encode(`${text}\0`));
    // WebAssembly's i32 are signed in JavaScript.
    const module = new Module({
        exports: {
            memory,
            strew_allocate: () => high | 0,
            strew_release: () => undefined,
            strew_bytes_data: () => (high + 64) | 0,
            strew_bytes_length: () => text.length,
            strew_bytes_free: () => undefined,
            strew_error_document: () => (high + 64) | 0,
            good: () => 0,
            bad: () => 1,
        },
    });
    assert.equal(module.scoped((room) => module.copied(room, "abc")), high);
    assert.equal(module.json("good").detail, "no");
    assert.equal(module.filled(Float64Array, 2, () => undefined).length, 2);
    assert.throws(() => module.call("bad"), { kind: "invalid-query" });
});

test("what JSON cannot hold keeps its place, to be refused by its name", () => {
    const odd = { spacing: NaN, keep: -Infinity, limit: () => 1, seed: Symbol("s"), world: null, warp: undefined };
    const words = '{"spacing":"NaN","keep":"-Infinity","limit":"[function]","seed":"[symbol]","world":null}';
    assert.equal(text(body(odd)), words);
    assert.equal(text(body({ bbox: [0, 0, 1, NaN] })), '{"region":{"bbox":[0,0,1,"NaN"]}}');
    assert.equal(text(body({ bbox: null, circle: [0, 1, 2] })), '{"region":{"circle":{"center":[0,1],"radius":2}}}');
});

test("volumes by keywords are those of bodies", () => {
    const region = (keywords) => body(keywords).region;
    assert.deepEqual(region({ ball: [0, 1, 2, 3] }), { ball: { center: [0, 1, 2], radius: 3 } });
    assert.deepEqual(region({ chunk: [16, -3, 2, 1] }), { chunk: { size: 16, x: -3, y: 2, z: 1 } });
    const ring = [[0, 0], [9, 0], [0, 9]];
    const polygon = { type: "Polygon", coordinates: [[...ring, ring[0]]] };
    assert.deepEqual(region({ prism: [ring, 1, 4] }), { prism: { polygon, bottom: 1, top: 4 } });
});
