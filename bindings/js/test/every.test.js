// Every parameter, shape of field, table and format, in the module and at the daemon: the same bytes, or the same words.
// What there is comes from the daemon's description of itself, so that nothing new is left out.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { inflateSync } from "node:zlib";

import { connect, pixels, raster } from "../lib/index.js";
import { KINDS } from "../lib/parameters.js";
import { text } from "../lib/query.js";
import { daemon, whole } from "./support.js";

const [strew, remote] = await Promise.all([whole(), daemon()]);
const skip = !remote && "the daemon is not built";
const there = remote && connect(remote.url);
const api = remote && (await (await fetch(`${remote.url}/openapi.json`)).json());
after(() => remote?.end());

/** The bytes of a document, or the words of a refusal. */
async function answer(source, query) {
    const { format = "json", decimals, size, summary, crs, ...set } = query;
    const stated = Object.entries({ decimals, size, summary, crs }).filter(([, value]) => value !== undefined);
    try {
        const points = query.region?.bbox?.length === 6 ? source.space.query(set) : source.query(set);
        return { bytes: Buffer.from(await points.document(format, Object.fromEntries(stated))) };
    } catch ({ message, faults, kind }) {
        // Kinds that are made take both their time: the daemon wants to be called again meanwhile.
        return kind === "time-over" ? answer(source, query) : { words: message, faults };
    }
}

/** What bytes say: packed pixels depend on the library that packs them. */
function content(bytes, format) {
    if (format !== "png") return bytes;
    const packed = [];
    for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) {
        if (bytes.toString("latin1", at + 4, at + 8) === "IDAT") packed.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32BE(at)));
    }
    return inflateSync(Buffer.concat(packed));
}

async function same(query) {
    const [own, other] = [await answer(strew, query), await answer(there, query)];
    assert.deepEqual([own.words, own.faults], [other.words, other.faults], text(query));
    const [ours, theirs] = [own, other].map(({ bytes }) => bytes && content(bytes, query.format));
    assert.ok(own.words !== undefined || ours.equals(theirs), `other bytes: ${text(query)}`);
    return own;
}

const SET = { spacing: 1, seed: 7 };
const BASE = { region: { bbox: [0, 0, 12, 9] }, ...SET };
const KIND = { ...BASE, attributes: ["variant"], variants: { oak: 3, birch: 1 } };
const RAMP = { ramp: { from: [0, 0], to: [12, 0] } };
const RING = [[0, 0], [12, 0], [12, 9], [0, 9], [0, 0]];
const HOLE = [[3, 3], [6, 3], [6, 6], [3, 3]];
const CRS = { type: "name", properties: { name: "urn:ogc:def:crs:EPSG::2154" } };
const POLYGON = { type: "Polygon", coordinates: [RING, HOLE] };
const PLACED = { ...SET, region: { polygon: { ...POLYGON, crs: CRS } } };
const BOX = { ...SET, region: { bbox: [0, 0, 0, 5, 5, 5] } };
const LAYERS = [
    { name: "trees", spacing: 3, seed: 1 },
    { name: "grass", spacing: 1, clear_of: { trees: 1 }, attributes: ["angle"] },
];
const hill = (where) => pixels(Float32Array.from({ length: 48 }, (_, i) => i), 8, 6, { bbox: [0, 0, 12, 9], ...where });

/** Queries about each parameter; those of lists that only a daemon has are refused by both. */
const QUERIES = {
    bbox: [BASE, BOX],
    circle: [{ ...SET, region: { circle: { center: [3, 4], radius: 5 } } }],
    polygon: [PLACED, { ...SET, region: { include: [BASE.region], exclude: [{ polygon: POLYGON }] } }],
    periodic: [{ region: undefined, periodic: 100, map: "s", density: 1 }],
    density: [{ ...BASE, spacing: undefined, density: 2 }],
    spacing: [{ ...BASE, spacing: 0.7 }],
    min_distance: [{ ...BASE, spacing: undefined, min_distance: 0.8 }],
    count: [{ ...BASE, spacing: undefined, count: 50 }, { ...BASE, spacing: undefined, count: 50, field: RAMP }],
    world: [{ ...BASE, world: "none" }],
    world_digest: [{ ...BASE, world_digest: "0".repeat(64) }],
    profile: [{ ...BASE, profile: "spaced" }, { ...BOX, profile: "spaced" }],
    alpha: [{ ...BASE, alpha: "(5-sqrt(3))/2" }, { ...BASE, alpha: "sqrt(3)", map: "s" }],
    map: ["s", "m", "l"].map((map) => ({ ...BASE, map })),
    table: [{ ...BASE, table: "0".repeat(64) }],
    seed: [0, 2n ** 64n - 1n, "9007199254740993"].map((seed) => ({ ...BASE, seed })),
    warp: ["off", "on", 0.5].map((warp) => ({ ...BASE, warp })),
    keep: [{ ...BASE, keep: 0.4 }, { ...BOX, keep: 0.4 }],
    settle: [0, 1, 2, 3, 4].map((settle) => ({ ...BASE, keep: 0.4, settle })),
    lod: [{ ...BASE, lod: 0.25 }],
    field: [{ ...BASE, field: RAMP }],
    except: [{ ...BASE, except: ["-2:5", "-2:11"] }],
    attributes: [{ ...BASE, attributes: ["angle", "rank", "u1", "u16"] }, { ...BOX, attributes: ["rotation", "scale"] }],
    scale_range: [{ ...BASE, attributes: ["scale"], scale_range: [2, 3] }],
    scale_ranges: [{ ...KIND, attributes: ["scale", "variant"], scale_ranges: { oak: [1, 2], birch: [0, 1] } }],
    variants: [KIND],
    spread: [
        ...["chance", "even", "joint"].map((spread) => ({ ...KIND, spread })),
        { ...KIND, spread: "even", keep: 0.4, settle: 2 },
        { ...KIND, spread: "even", variants: { oak: 1, birch: 5 } },
    ],
    variant_fields: [{ ...KIND, spread: "even", variant_fields: { birch: RAMP } }],
    only: ["even", "joint"].map((spread) => ({ ...KIND, spread, only: "birch" })),
    offset: [{ ...BASE, offset: 9 }, { ...BASE, layers: LAYERS, spacing: undefined, offset: 20 }],
    limit: [{ ...BASE, limit: 9 }, { ...BOX, limit: 9 }],
    cursor: [{ ...BASE, cursor: "00" }],
    format: [],
    decimals: [{ ...BASE, format: "csv", decimals: 2 }],
    size: [{ ...BASE, format: "svg", size: 64 }],
    summary: [{ ...BASE, format: "ndjson", summary: false }],
    crs: ["EPSG:2154", "2154"].map((crs) => ({ ...PLACED, format: "geojson", crs })),
    terrain: [{ ...BASE, terrain: RAMP }, { ...BASE, terrain: { raster: hill({ white: 47 }) } }],
    heights: [{ ...BASE, terrain: RAMP, heights: [5, 9] }],
    normals: [{ ...BASE, terrain: RAMP, normals: true }],
    align: [{ ...BASE, terrain: RAMP, align: 0.5, attributes: ["angle"] }],
};

const SHAPES = {
    constant: { constant: 0.4 },
    ramp: RAMP,
    radial: { radial: { center: [3, 3], radii: [1, 9] } },
    distance: { distance: { lines: [[[0, 0], [9, 9]]], distances: [1, 4] } },
    noise: { noise: { wavelength: 5, octaves: 2 } },
    raster: raster(new Uint8Array([0, 255, 128, 9, 8, 255]), 3, 2, { bbox: [0, 0, 12, 9], edges: "mirror", gamma: 2 }),
    height: { height: { terrain: hill({}), heights: [5, 40] } },
    slope: { slope: { terrain: hill({ edges: "clamp" }), slopes: [0.1, 9] } },
    multiply: { multiply: [RAMP, { constant: 0.5 }] },
    min: { min: [RAMP, { constant: 0.5 }] },
    max: { max: [RAMP, { constant: 0.5 }] },
    invert: { invert: RAMP },
    curve: { curve: { of: RAMP, points: [[0, 1], [0.5, 0], [1, 1]] } },
};

test("every parameter", { skip }, async () => {
    assert.deepEqual(Object.keys(QUERIES).sort(), Object.keys(KINDS).sort());
    for (const [name, queries] of Object.entries(QUERIES)) {
        for (const query of queries) {
            const { words } = await same(query);
            const isRefused = ["world", "world_digest", "table", "cursor"].includes(name) || "crs" in query;
            assert.ok(words === undefined || isRefused, `${name}: ${words}`);
        }
    }
});

test("every shape of field", { skip }, async () => {
    const known = api.components.schemas.Field.anyOf.map(({ $ref }) => api.components.schemas[$ref.split("/").at(-1)]);
    // A field is named by its digest once both hold it.
    const name = strew.backend.holdField(text(RAMP));
    assert.equal(await there.backend.holdField(text(RAMP)), name);
    const shapes = { ...SHAPES, name: { name } };
    assert.deepEqual(Object.keys(shapes).sort(), known.map(({ required }) => required[0]).sort());
    for (const [shape, field] of Object.entries(shapes)) {
        for (const more of [{ field }, { field, keep: 0.5, settle: 0 }, { terrain: field, heights: [0, 50] }]) {
            const { words } = await same({ ...BASE, ...more });
            assert.equal(words, undefined, shape);
        }
    }
});

test("every table that is shipped", { skip }, async () => {
    for (const [root, base, few] of [["/v1", BASE, 15], ["/v1/space", BOX, 1]]) {
        const { profiles } = await (await fetch(`${remote.url}${root}/profiles`)).json();
        assert.ok(profiles.length > few);
        for (const { profile, alpha, map } of profiles) {
            const { words } = await same({ ...base, profile, alpha, map });
            assert.equal(words, undefined, `${profile} ${alpha} ${map}`);
        }
    }
});

test("every format", { skip }, async () => {
    const parameters = api.paths["/v1/points"].get.parameters.map(({ $ref, ...own }) =>
        $ref ? api.components.parameters[$ref.split("/").at(-1)] : own,
    );
    const { schema } = parameters.find(({ name }) => name === "format");
    assert.ok(schema.enum.length > 10);
    const layers = { ...BASE, spacing: undefined, layers: LAYERS };
    const tall = { ...KIND, terrain: RAMP, align: 0.5, attributes: ["angle", "scale", "variant"] };
    for (const format of schema.enum) {
        for (const query of [BASE, PLACED, BOX, layers, tall, { ...SET, region: { chunk: { size: 8, x: -1, y: 2 } } }]) {
            if (format === "arrow") {
                assert.match((await answer(strew, { ...query, format })).words, /arrow/);
                continue;
            }
            const { words } = await same({ ...query, format });
            const lacksRotation = format === "instances" && query === tall;
            assert.ok(words === undefined || lacksRotation, `${format}: ${words}`);
        }
    }
});
