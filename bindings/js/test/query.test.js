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
