// Points in space: the points, documents and words of the real daemon, for 200 random queries of the Python package.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";
import { after, before, test } from "node:test";

import { DEFAULT_TABLES, SPACE_TABLES, connect, open } from "../lib/index.js";
import { SPACE } from "../lib/query.js";
import { daemon, whole } from "./support.js";

const QUERIES = 200;
const queries = () => {
    const folder = fileURLToPath(new URL("../../python/tests", import.meta.url));
    const listed = `for seed in range(${QUERIES}): print(json.dumps(queries.random_query_in_space(seed)))`;
    const code = `import json, queries\n${listed}`;
    const lines = execFileSync("python3", ["-c", code], { cwd: folder, encoding: "utf8", maxBuffer: 1 << 26 });
    return lines.trim().split("\n");
};

let strew;
let remote;
before(async () => {
    strew = await whole();
    remote = await daemon();
});
after(() => remote?.end());

const headers = { "content-type": "application/json" };
const ask = (body) => fetch(`${remote.url}/v1/space/points`, { method: "POST", body, headers });

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

test("random queries have the points of the daemon", async (t) => {
    if (!remote) return t.skip("the daemon is not built");
    for (const text of queries()) {
        const content = await (await ask(text)).text();
        const plan = strew.plan(text, undefined, SPACE);
        assert.equal(new TextDecoder().decode(plan.document({ format: "json" })), content);
        const { points } = JSON.parse(content);
        const { ids, at, further } = plan.columns();
        assert.deepEqual([...at], points.flatMap(({ x, y, z }) => [x, y, z]));
        assert.deepEqual([...ids], points.flatMap(({ id }) => id.split(":").map(BigInt)));
        for (const [name, { names, values }] of further) {
            const own = Array.from(values, (v) => (names ? (names[v] ?? null) : isNaN(v) ? null : v));
            assert.deepEqual(own, points.map((point) => point[name] ?? null), name);
        }
        plan.free();
    }
});

test("a daemon has the functions of the package", async (t) => {
    if (!remote) return t.skip("the daemon is not built");
    const attributes = { attributes: ["rotation", "variant"], variants: { oak: 1, fir: 2 } };
    const query = { bbox: [-5, -5, -5, 6, 7, 8], spacing: 1.5, seed: 2n ** 63n, ...attributes };
    const layers = [{ name: "a", spacing: 2, ...attributes }, { name: "b", spacing: 3, clear_of: { a: 1 } }];
    const chunk = { ...query, bbox: null, chunk: [8, -1, 0, 2] };
    for (const keywords of [query, chunk, { ...query, limit: 9 }, { ball: [1, 2, 3, 6], layers }]) {
        const [here, far] = [strew, connect(remote.url)].map((source) => source.space.points(keywords));
        assert.equal(await far.count(), here.count());
        assert.deepEqual(await far.names(), here.names());
        assert.deepEqual(await far.xyz(), here.xyz());
        assert.deepEqual(await far.xyzF32(), here.xyzF32());
        assert.deepEqual(await far.ids(), here.ids());
        assert.deepEqual(await far.origin(), here.origin());
        for (const name of here.names()) assert.deepEqual(await far.column(name), here.column(name), name);
        assert.deepEqual(await far.resolved(), here.resolved());
        assert.deepEqual((await far.split(2)).map(({ body }) => body), here.split(2).map(({ body }) => body));
        assert.deepEqual(await far.document("csv", { decimals: 2 }), here.document("csv", { decimals: 2 }));
        if (keywords.layers) continue;
        const found = here.nearest([3, 4, 5], { k: 3 });
        assert.deepEqual(await far.nearest([3, 4, 5], { k: 3 }), found);
        assert.deepEqual(await far.point(found[0].id), here.point(found[0].id));
    }
});

test("wrong queries are refused with the same words", async (t) => {
    if (!remote) return t.skip("the daemon is not built");
    const region = { bbox: [0, 0, 0, 1, 1, 1] };
    const wrong = [
        {},
        { region: { bbox: [0, 0, 1, 1] }, spacing: 1 },
        { region, spacing: 1, attributes: ["angle"] },
        { region, spacing: -1, field: "forest" },
        { region, spacing: 1, profile: "pink" },
    ];
    for (const query of wrong) {
        const problem = await (await ask(JSON.stringify(query))).json();
        const words = ({ message, kind, faults }) => {
            assert.deepEqual([message, kind, faults], [problem.detail, problem.type.split(":").at(-1), problem.errors]);
            return true;
        };
        assert.throws(() => strew.space.query(query).plan(), words);
        await assert.rejects(connect(remote.url).space.query(query).xyz(), words);
    }
});
