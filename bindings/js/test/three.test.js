// strew/three without a screen: chunks around a camera, against three itself where it is installed.
import assert from "node:assert/strict";
import { test } from "node:test";

import { open } from "../lib/lite.js";

const three = await import("three").catch(() => undefined);
const skip = three ? false : "the npm package three is missing";

const KINDS = { attributes: "angle, scale, variant, rank", variants: { oak: 3, birch: 1 } };
const SET = { map: "s", spacing: 2, seed: 5, ...KINDS };
const OPTIONS = { side: 16, near: 20, far: 60 };

async function made(points, options = OPTIONS) {
    const { Chunks } = await import("../lib/three.js");
    const kind = [[new three.BoxGeometry(), new three.MeshBasicMaterial()]];
    const camera = new three.PerspectiveCamera(50, 1, 0.1, 500);
    camera.position.set(8, 2, -8);
    return { camera, chunks: new Chunks(points, { oak: kind, birch: kind }, options) };
}

/** Updates until nothing is missing. */
async function settled(chunks, camera, origin) {
    for (let i = 0; i < 200; i++) {
        chunks.update(camera, origin);
        if (!chunks.missing) return;
        // Chunks come in microtasks.
        await new Promise(setImmediate);
    }
    assert.fail(`${chunks.missing} chunks are missing`);
}

test("instances are the points, thinned by distance, culled and freed", { skip }, async () => {
    const forest = (await open()).points(SET);
    const { camera, chunks } = await made(forest);
    await settled(chunks, camera);
    const near = chunks.group.children.find(({ position }) => position.x === 0 && position.z === 0);
    const meshes = near.children;
    const own = forest.chunk(16, 0, 0);
    assert.equal(meshes.reduce((sum, { count }) => sum + count, 0), own.count());
    const places = meshes.flatMap((mesh) =>
        Array.from({ length: mesh.count }, (_, i) => {
            const matrix = new three.Matrix4();
            mesh.getMatrixAt(i, matrix);
            return [matrix.elements[12], -matrix.elements[14]].join();
        }),
    );
    const { xy } = own.xyF32();
    assert.deepEqual(places.sort(), Array.from({ length: xy.length / 2 }, (_, i) => [xy[2 * i], xy[2 * i + 1]].join()).sort());
    assert.ok(chunks.drawn > 0 && chunks.drawn < chunks.loaded, `${chunks.drawn} of ${chunks.loaded}`);
    // The camera looks along −z, where y grows: what is behind it is not seen.
    const behind = chunks.group.children.filter(({ position }) => position.z > 40);
    assert.ok(behind.length && behind.every(({ visible }) => !visible));
    const [before, size] = [new Set(chunks.group.children), chunks.size];
    camera.position.set(5000, 2, -8);
    await settled(chunks, camera);
    assert.equal(chunks.size, size);
    assert.ok(chunks.group.children.every((group) => !before.has(group)));
    chunks.dispose();
    assert.equal(chunks.group.children.length, 0);
});

test("the scene's origin may be anywhere", { skip }, async () => {
    const forest = (await open()).points(SET);
    const [here, there] = [await made(forest), await made(forest)];
    there.camera.position.x -= 1024;
    await settled(here.chunks, here.camera);
    await settled(there.chunks, there.camera, [1024, 0]);
    assert.deepEqual([there.chunks.loaded, there.chunks.drawn], [here.chunks.loaded, here.chunks.drawn]);
});

test("a chunk that failed is requested again after a pause", { skip }, async (t) => {
    let now = 0;
    t.mock.method(performance, "now", () => now);
    const forest = (await open()).points(SET);
    let fails = true;
    const points = {
        chunk: (...cell) => {
            if (fails) throw new Error("no daemon");
            return forest.chunk(...cell);
        },
    };
    const { camera, chunks } = await made(points);
    now = 10;
    chunks.update(camera);
    await new Promise(setImmediate);
    assert.equal(chunks.error.message, "no daemon");
    assert.equal(chunks.size, 0);
    fails = false;
    chunks.update(camera);
    await new Promise(setImmediate);
    // Not before the pause is over.
    assert.equal(chunks.size, 0);
    now = 2000;
    await settled(chunks, camera);
    assert.equal(chunks.error, null);
    assert.ok(chunks.size > 0);
});
