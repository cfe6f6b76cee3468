// strew/lite beside the whole package: the same bits, and words of the same form.
import assert from "node:assert/strict";
import { test } from "node:test";

import { StrewError, open as openWhole } from "../lib/index.js";
import { open as openEmbedded } from "../lib/lite-embedded.js";
import { open } from "../lib/lite.js";
import { ALL, whole as everything } from "./support.js";

const [lite, whole] = await Promise.all([open(), openWhole({ tables: ["blue-5-sqrt3-over-2-s.strew"] })]);

/** What a work returns, or the faults of its error. */
const tried = (work) => {
    try {
        return work();
    } catch ({ faults }) {
        return faults;
    }
};

/** Numbers of a seed, so that a failure comes again. */
function random(seed) {
    let state = seed;
    return (low, high) => {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        return low + (state / 2 ** 32) * (high - low);
    };
}

function query(draw) {
    const maybe = (members) => (draw(0, 1) < 0.4 ? members : {});
    const amount = [{ spacing: draw(0.5, 3) }, { density: draw(0.2, 3) }, { min_distance: draw(0.4, 2) }];
    const named = { attributes: ["angle", "rank", "u3"] };
    const all = { attributes: "variant, scale, angle", variants: { oak: 3, birch: 1.5, Elm: 0.2 }, scale_range: [0.5, 2] };
    return {
        map: "s",
        ...amount[Math.floor(draw(0, 3))],
        seed: [0, Math.floor(draw(1, 1e9)), 2n ** 64n - 1n][Math.floor(draw(0, 3))],
        ...maybe({ warp: [0, 0.7, "on", "off", 2][Math.floor(draw(0, 5))] }),
        ...maybe({ keep: draw(0.05, 1), ...maybe({ settle: Math.floor(draw(0, 5)) }) }),
        ...maybe({ lod: draw(0.1, 1) }),
        ...maybe(draw(0, 1) < 0.5 ? named : all),
    };
}

function region(draw) {
    const [x, y, far] = [draw(-1, 1), draw(-1, 1), draw(0, 1) < 0.3 ? 1e9 : 100];
    const [left, top] = [x * far, y * far];
    const shapes = [
        { bbox: [left, top, left + draw(0.1, 30), top + draw(0.1, 30)] },
        { circle: [left, top, draw(0.1, 15)] },
        { chunk: [draw(1, 30), Math.floor(left / 30), Math.floor(top / 30)] },
    ];
    return shapes[Math.floor(draw(0, 3))];
}

test("random queries have the bits of the whole package", () => {
    const draw = random(7);
    let refused = 0;
    for (let i = 0; i < 150; i++) {
        const asked = query(draw);
        const [ours, theirs] = [lite.points(asked), whole.points(asked)];
        const shape = region(draw);
        const about = JSON.stringify({ ...asked, seed: String(asked.seed), ...shape });
        const [here, there] = [tried(() => ours.within(shape)), tried(() => theirs.within(shape))];
        if (Array.isArray(there)) {
            assert.deepEqual(...[here, there].map((faults) => faults.map(({ field }) => field)), about);
            refused += 1;
            continue;
        }
        assert.equal(here.count(), there.count(), about);
        assert.deepEqual(here.origin(), there.origin(), about);
        for (const each of ["xy", "xyF32", "ids", "names", "rowsF32"]) assert.deepEqual(here[each](), there[each](), about);
        for (const name of here.names()) assert.deepEqual(here.column(name), there.column(name), about);
        assert.deepEqual([...here], [...there], about);
        const at = [draw(-1e3, 1e3), draw(-1e3, 1e3)];
        for (const limits of [{}, { k: 3 }, { radius: 4 }, { k: 2, radius: 3 }]) {
            assert.deepEqual(ours.nearest(at, limits), theirs.nearest(at, limits), about);
        }
        const [near] = ours.nearest(at);
        // The whole package has the block of the map as well.
        const { block: _, ...point } = theirs.point(near.id);
        assert.deepEqual(ours.point(near.id), point, about);
        here.free();
        there.free();
    }
    assert.ok(refused > 0 && refused < 20, `${refused} refused`);
});

test("what is wrong has its member, its value and what is allowed", () => {
    for (const [odd, field] of [
        [{ spacing: NaN }, "spacing"], [{ spacing: -1 }, "spacing"], [{ spacing: "1" }, "spacing"],
        [{ spacing: 1, seed: -1 }, "seed"], [{ spacing: 1, seed: 0.5 }, "seed"], [{ spacing: 1, seed: Infinity }, "seed"],
        [{ spacing: 1, warp: 3 }, "warp"], [{ spacing: 1, keep: 0 }, "keep"], [{ spacing: 1, settle: 5 }, "settle"],
        [{ spacing: 1, attributes: "angel" }, "attributes"], [{ spacing: 1, attributes: "variant" }, "variants"],
        [{ spacing: 1, scale_range: [1, 2] }, "scale_range"], [{ spacing: 1, foo: null }, "foo"],
        [{ spacing: 1, foo: () => 1 }, "foo"], [{ spacing: 1, keep: Symbol("x") }, "keep"], [{}, "spacing"],
        [{ spacing: 1, bbox: [0, 0, 1] }, "region.bbox"], [{ spacing: 1, bbox: [0, 0, 1, NaN] }, "region.bbox"],
        [{ spacing: 1, chunk: [4, 0.5, 1] }, "region.chunk"], [{ spacing: 1, polygon: [[0, 0]] }, "region"],
        [{ spacing: 1, circle: [0, 0, 0] }, "region.circle"], [{ spacing: 1, bbox: [0, 0, 1e300, 1] }, "region"],
        [{ spacing: 1, chunk: "x" }, "region.chunk"], [{ spacing: 1, circle: { center: 5 } }, "region.circle"],
        [{ spacing: 1, warp: "constructor" }, "warp"], [{ spacing: 1, attributes: [undefined] }, "attributes"],
    ]) {
        assert.throws(() => lite.points({ map: "s", ...odd }), (error) => {
            assert.ok(error instanceof StrewError, error);
            assert.deepEqual([error.kind, error.faults.map((fault) => fault.field)], ["invalid-query", [field]]);
            assert.match(error.message, /allowed: /);
            return true;
        });
    }
    const bbox = [0, 0, 9, 9];
    for (const odd of [
        { spacing: -1, bbox }, { spacing: 1e101, bbox }, { spacing: 1, seed: 0.5, bbox },
        { spacing: 1, seed: 2n ** 64n, bbox }, { spacing: 1, settle: 5, bbox }, { spacing: 1, keep: 0, bbox },
    ]) {
        const [own, full] = [lite, whole].map((strew) => tried(() => strew.points({ map: "s", ...odd }).count()));
        assert.equal(own[0].detail, full[0].detail);
    }
    const small = (keywords) => lite.points({ map: "s", ...keywords });
    assert.throws(() => small({ spacing: NaN }), /`spacing` = .*: must be a number/);
    assert.throws(() => small({ spacing: 1, bbox: [0, 0, 1] }), /expected 4 numbers, got 3/);
    assert.deepEqual(small({ spacing: 1, seed: "9", bbox }).xy(), small({ spacing: 1, seed: 9, bbox }).xy());
    assert.throws(() => small({ spacing: 1 }).nearest(), /`at`: .*two finite numbers/);
    assert.throws(() => small({ spacing: 1 }).nearest([0, NaN]), /`at` = .*two finite numbers/);
    assert.throws(() => small({ spacing: 1 }).point("1:1"), { kind: "no-such-point" });
    assert.throws(() => small({ spacing: 1 }).count(), /one of bbox, chunk, circle/);
    assert.throws(() => small({ spacing: 1, bbox: [0, 0, 9, 9] }).document("csv"), { kind: "unsupported" });
});

test("a query has the points that it has everywhere, or says what must be named", async () => {
    const asked = { spacing: 1, seed: 7, bbox: [0, 0, 10, 10] };
    const of = (name) => open({ table: ALL.find((url) => url.pathname.endsWith(`/${name}.strew`)) });
    const [green, usual] = await Promise.all(["green-5-sqrt3-over-2-s", "blue-5-sqrt3-over-2-m"].map(of));
    const there = await everything();
    for (const [strew, named, wrong] of [
        [lite, { map: "s" }, { map: "m" }], [usual, {}, { map: "s" }], [usual, { map: "m" }, { profile: "green" }],
        [green, { profile: "green", map: "s" }, { profile: "green" }],
        [green, { map: "s", profile: "green", alpha: "(5-sqrt(3))/2" }, { map: "s", profile: "green", alpha: 1.5 }],
    ]) {
        assert.deepEqual(strew.points({ ...asked, ...named }).ids(), there.points({ ...asked, ...named }).ids());
        assert.throws(() => strew.points({ ...asked, ...wrong }), /or open\(\{ table \}\) with another file/);
    }
    assert.throws(() => lite.points(asked), {
        message:
            "`map`: is missing: without it the query means the table of map m, which is not open; allowed: " +
            'map: "s", or open({ table }) with another file, as of the package strew-tables',
    });
});

test("numbers of errors of the module are those of the whole package", () => {
    const far = { map: "s", spacing: 1, bbox: [0, 0, 1e300, 1] };
    const [[own], [full]] = [lite, whole].map((strew) => tried(() => strew.points(far).count()));
    const limit = /within ±[\d.]+/;
    assert.equal(own.value, "1e300");
    assert.deepEqual(own.allowed.match(limit)[0], full.allowed.match(limit)[0]);
    const forest = lite.points({ map: "s", spacing: 1 });
    assert.throws(() => forest.nearest([0, 0], { radius: 1000 }), /about 3141593 points lie within/);
});

test("sets that were dropped are made again, and freed plans have no points", () => {
    const first = lite.points({ map: "s", spacing: 2, seed: 3, bbox: [0, 0, 20, 20] });
    const [xy, plan] = [first.xy(), first.plan()];
    for (let seed = 0; seed < 40; seed++) lite.points({ map: "s", spacing: 2, seed }).chunk(8, 0, 0).free();
    assert.deepEqual(first.xy(), xy);
    first.free();
    assert.throws(() => plan.count(), { kind: "invalid-argument" });
    assert.deepEqual(first.xy(), xy);
});

test("the embedded module has the same points", async () => {
    const [embedded, asked] = [await openEmbedded(), { map: "s", spacing: 1, seed: 7, bbox: [0, 0, 10, 10] }];
    assert.deepEqual(embedded.points(asked).xy(), lite.points(asked).xy());
});
