// The same points, documents and words as the real daemon, for random queries, in the plane and in space: those of the
// Python package.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";
import { after, test } from "node:test";

import { connect } from "../lib/index.js";
import { PLANE, SPACE } from "../lib/query.js";
import { daemon, whole } from "./support.js";

const queries = (name, count) => {
    const folder = fileURLToPath(new URL("../../python/tests", import.meta.url));
    const code = `import json, queries\nfor seed in range(${count}): print(json.dumps(queries.${name}(seed)))`;
    const lines = execFileSync("python3", ["-c", code], { cwd: folder, encoding: "utf8", maxBuffer: 1 << 26 });
    return lines.trim().split("\n");
};

const [strew, remote] = await Promise.all([whole(), daemon()]);
const skip = !remote && "the daemon is not built";
after(() => remote?.end());

// The module makes kinds for seconds, in which an idle connection may be closed.
const headers = { "content-type": "application/json", connection: "close" };
const ask = (body, { queries } = PLANE) => fetch(remote.url + queries, { method: "POST", body, headers });

function samePoints(plan, points, axes) {
    const { ids, at, further } = plan.columns();
    assert.deepEqual([...at], points.flatMap((point) => [...axes].map((axis) => point[axis])));
    assert.deepEqual([...ids], points.flatMap(({ id }) => id.split(":").map(BigInt)));
    for (const [name, { names, values }] of further) {
        const expected = points.map((point) => point[name] ?? null);
        const own = Array.from(values, (v) => (names ? (names[v] ?? null) : isNaN(v) ? null : v));
        assert.deepEqual(own, expected, name);
    }
}

function sameWords(error, problem) {
    const own = [error.message, error.kind, error.faults];
    assert.deepEqual(own, [problem.detail, problem.type.split(":").at(-1), problem.errors ?? []]);
}

for (const [dimension, name, count] of [[PLANE, "random_query", 1000], [SPACE, "random_query_in_space", 200]]) {
    test(`random queries have the points of the daemon: ${dimension.axes}`, { skip }, async () => {
        let refused = 0;
        for (const text of queries(name, count)) {
            const response = await ask(text, dimension);
            const content = await response.text();
            let plan;
            try {
                plan = strew.backend.plan(text, undefined, dimension);
            } catch (error) {
                sameWords(error, JSON.parse(content));
                refused++;
                continue;
            }
            assert.ok(response.ok, content);
            assert.equal(new TextDecoder().decode(plan.document({ format: "json" })), content);
            samePoints(plan, JSON.parse(content).points, dimension.axes);
            plan.free();
        }
        assert.ok(refused < count / 50);
    });
}

const WRONG = [
    {},
    { region: {}, spacing: 1 },
    { region: { bbox: [0, 0, 0, 1] }, spacing: 1 },
    { region: { bbox: [0, 0, 1, 1] }, spacing: -1, sed: 3 },
    { region: { bbox: [0, 0, 1, 1] }, spacing: 1, profile: "blu" },
    { region: { bbox: [0, 0, 1, 1] }, spacing: 1, table: "0".repeat(64) },
    { region: { bbox: [0, 0, 1, 1] }, spacing: 1, field: { noise: { wavelength: -1 } } },
    { region: { bbox: [0, 0, 1e300, 1] }, spacing: 1 },
];

const BOX = { bbox: [0, 0, 0, 1, 1, 1] };
const WRONG_IN_SPACE = [
    {},
    { region: { bbox: [0, 0, 1, 1] }, spacing: 1 },
    { region: BOX, spacing: 1, attributes: ["angle"] },
    { region: BOX, spacing: -1, sed: 3 },
    { region: BOX, spacing: 1, profile: "pink" },
];

test("wrong queries are refused with the same words", { skip }, async () => {
    for (const [dimension, wrong] of [[PLANE, WRONG], [SPACE, WRONG_IN_SPACE]]) {
        for (const query of wrong) {
            const problem = await (await ask(JSON.stringify(query), dimension)).json();
            const words = (error) => sameWords(error, problem) ?? true;
            assert.throws(() => strew.backend.plan(JSON.stringify(query), query, dimension), words);
            const source = connect(remote.url);
            await assert.rejects((dimension === SPACE ? source.space : source).query(query).ids(), words);
        }
    }
});

test("columns, their names and their order are those of the package", { skip }, async () => {
    const variants = (names) => ({ attributes: ["variant", "angle"], variants: names });
    const layers = [
        { name: "trees", spacing: 2, seed: 1, ...variants({ oak: 1, birch: 1 }) },
        { name: "rocks", spacing: 5, ...variants({ slate: 1, birch: 1 }) },
        { name: "bare", spacing: 9 },
    ];
    const ramp = { ramp: { from: [0, 0], to: [9, 0] } };
    for (const side of [20, 0.001]) {
        const region = { bbox: [0, 0, side, side] };
        const written = { format: "csv", decimals: 1 };
        const terrain = { terrain: ramp, align: 0.5 };
        for (const set of [{ layers }, { spacing: 1, ...terrain }, { spacing: 1, ...variants({ a: 1, b: 2 }) }]) {
            const query = { region, ...set, ...written };
            const [here, far] = [strew.query(query), connect(remote.url).query(query)];
            assert.deepEqual(await far.names(), here.names());
            assert.deepEqual(await far.xy(), here.xy());
            assert.deepEqual(await far.resolved(), here.resolved());
            for (const name of here.names()) assert.deepEqual(await far.column(name), here.column(name), name);
            if (set.spacing) assert.deepEqual(await far.nearest([3, 3]), here.nearest([3, 3]));
        }
        for (const name of ["layer", "variant"]) {
            const [here, far] = [strew, connect(remote.url)].map((source) => source.query({ region, layers }));
            assert.deepEqual(await far.codes(name), here.codes(name), name);
        }
    }
});

test("counts of any size are exact", { skip }, async () => {
    const points = connect(remote.url).points({ bbox: [-5e8, -5e8, 5e8, 5e8], spacing: 1 });
    assert.equal(await points.count(), 1000000000097677487n);
    assert.equal((await points.split(1))[0].body.limit, 1000000000097677487n);
});

test("a daemon has the functions of the package", { skip }, async () => {
    const variants = { oak: 1, fir: 2 };
    const query = { bbox: [-9, -9, 20, 21], spacing: 1.5, seed: 2n ** 63n, attributes: ["angle", "variant"], variants };
    const field = { noise: { wavelength: 9 } };
    const pose = { attributes: ["rotation", "variant"], variants };
    const box = { ...query, ...pose, bbox: [-5, -5, -5, 6, 7, 8] };
    const layers = [{ name: "a", spacing: 2, ...pose }, { name: "b", spacing: 3, clear_of: { a: 1 } }];
    const [chunk, cube] = [{ ...query, chunk: [16, -1, 0], bbox: null }, { ...box, chunk: [8, -1, 0, 2], bbox: null }];
    const inSpace = [box, cube, { ...box, limit: 9 }, { ball: [1, 2, 3, 6], layers }];
    for (const keywords of [query, { ...query, field }, chunk, { ...query, limit: 9 }, ...inSpace]) {
        const isFlat = !inSpace.includes(keywords);
        const [at, places] = isFlat ? [[3, 4], ["xy", "xyF32"]] : [[3, 4, 5], ["xyz", "xyzF32"]];
        const sources = [strew, connect(remote.url)].map((source) => (isFlat ? source : source.space));
        const [here, far] = sources.map((source) => source.points(keywords));
        for (const each of ["count", "names", "ids", "origin", "resolved", ...places]) {
            assert.deepEqual(await far[each](), here[each](), each);
        }
        for (const name of here.names()) assert.deepEqual(await far.column(name), here.column(name), name);
        assert.deepEqual((await far.split(2)).map(({ body }) => body), here.split(2).map(({ body }) => body));
        assert.deepEqual(await far.document("csv", { decimals: 2 }), here.document("csv", { decimals: 2 }));
        if (keywords.layers) continue;
        const found = here.nearest(at, { k: 3 });
        assert.deepEqual(await far.nearest(at, { k: 3 }), found);
        assert.deepEqual(await far.point(found[0].id), here.point(found[0].id));
    }
});
