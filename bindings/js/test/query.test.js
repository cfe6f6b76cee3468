// Keywords as the body of a request, without points.
import assert from "node:assert/strict";
import { test } from "node:test";

import { body, text } from "../lib/query.js";

test("what JSON cannot hold keeps its place, to be refused by its name", () => {
    const odd = { spacing: NaN, keep: -Infinity, limit: () => 1, seed: Symbol("s"), world: null, warp: undefined };
    assert.equal(
        text(body(odd)),
        '{"spacing":"NaN","keep":"-Infinity","limit":"[function]","seed":"[symbol]","world":null}',
    );
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
