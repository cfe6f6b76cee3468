// What compiles with the package's types, and what does not: `tsc --strict` over this file, by test/types.mjs.
import { open, raster, type Query } from "strew";
import { connect } from "strew/connect";
import { open as openLite } from "strew/lite";
import { Chunks } from "strew/three";
import blueSmall from "strew-tables/green-5-sqrt3-over-2-s";

const strew = await open({ tables: ["blue-5-sqrt3-over-2-m.strew", blueSmall] });
const bbox = [0, 0, 10, 10] as const;

// Everything that is right compiles.
const points = strew.points({ bbox, spacing: 1, seed: 7n, warp: "on", keep: 0.5, attributes: ["angle", "variant"] });
const more: number = points.count() + 1;
const [x, y]: [number, number] = points.origin();
strew.points({ bbox: new Float64Array(4), spacing: 1, scale_ranges: { oak: [0.5, 1] }, variants: { oak: 1 } });
strew.points({ chunk: [64, -3, 2], spacing: 1, spread: "even", only: "oak", except: "cut", world: "w" });
strew.points({ periodic: 5, spacing: 1 }).xy();
strew.points({ bbox, world: "w" }).xy();
strew.points({ circle: [0, 0, 3], spacing: 1, variant_fields: { oak: raster([1, 0], 2, 1) }, crs: "EPSG:3857" });
strew.points({ layers: [{ name: "trees", spacing: 2 }, { name: "grass", spacing: 1, clear_of: { trees: 1 } }], bbox });
strew.space.points({ ball: [0, 0, 0, 9], spacing: 1, attributes: "rotation" }).nearest([1, 2, 3], { k: 2 });
strew.space.points({ prism: [[[0, 0], [9, 0], [0, 9]], 0, 4], spacing: 1 }).chunk(16, 1, 2, 3);
strew.points({ circle: { center: [0, 0], radius: 3 }, spacing: 1 }).within({ chunk: { size: 4, x: 1, y: 2 } });
const remote: Promise<number> = connect("http://localhost:8080").points({ bbox, spacing: 1 }).count();
const lite = await openLite();
const kinds = { variants: { oak: 1 }, attributes: "variant" };
const few: number = lite.points({ chunk: [64, 0, 0], map: "s", spacing: 2, ...kinds }).count();
new Chunks(lite.points({ map: "s", spacing: 2 }), [], { side: 64 }).update;
const angles: Float64Array = points.column("angle");
const names: (string | null)[] = points.column("variant");
for (const name of points.names()) points.column(name);
const forest = strew.points({ spacing: 2, seed: 5 });
forest.chunk(64, -3, 2).xy();
forest.within({ polygon: [[0, 0], [9, 0], [0, 9]] }).count();
strew.points({ features: { of: {}, count: "trees" } }).xy();
strew.points({ features: { of: {} }, spacing: 1 }).xy();
(await openLite({ table: blueSmall })).points({ profile: "green", map: "s", bbox, density: 1 }).xy();
new Chunks(connect("http://localhost:8080").points({ spacing: 2 }), { oak: [] });
const kept: Query = { spacing: 1, bbox, seed: "9007199254740993" };
export const used = [more, x, y, remote, few, kept, angles, names, strew.points(kept).count()];

// @ts-expect-error: a name that is misspelled
strew.points({ bbox, spacng: 1 });
// @ts-expect-error: a box of three numbers
strew.points({ bbox: [0, 0, 1], spacing: 1 });
// @ts-expect-error: a box of five numbers
strew.points({ bbox: [0, 0, 1, 1, 1], spacing: 1 });
// @ts-expect-error: a circle without a radius
strew.points({ circle: [0, 0], spacing: 1 });
// @ts-expect-error: a chunk without a row
strew.points({ chunk: [64, 0], spacing: 1 });
// @ts-expect-error: a number as text
strew.points({ bbox, spacing: "1" });
// @ts-expect-error: a seed as a word
strew.points({ bbox, spacing: 1, seed: "seven" });
// @ts-expect-error: a limit as a word
strew.points({ bbox, spacing: 1, limit: "few" });
// @ts-expect-error: no word of `spread`
strew.points({ bbox, spacing: 1, spread: "evn" });
// @ts-expect-error: a range as text
strew.points({ bbox, spacing: 1, scale_range: "huh" });
// @ts-expect-error: a range of three numbers
strew.points({ bbox, spacing: 1, scale_range: [0, 1, 2] });
// @ts-expect-error: a range of one number
strew.points({ bbox, spacing: 1, scale_ranges: { oak: [0] } });
// @ts-expect-error: weights as text
strew.points({ bbox, spacing: 1, variants: "oak:3" });
// @ts-expect-error: attributes as a number
strew.points({ bbox, spacing: 1, attributes: 1 });
// @ts-expect-error: no word of `warp`
strew.points({ bbox, spacing: 1, warp: "strong" });
// @ts-expect-error: a number as `world`
strew.points({ bbox, spacing: 1, world: 3 });
// @ts-expect-error: a function as a value
strew.points({ bbox, spacing: 1, keep: () => 1 });
// @ts-expect-error: null is no number
strew.points({ bbox, spacing: null });
// @ts-expect-error: a layer without a name
strew.points({ bbox, layers: [{ spacing: 1 }] });
// @ts-expect-error: a layer with a name that is misspelled
strew.points({ bbox, layers: [{ name: "trees", spacng: 1 }] });
// @ts-expect-error: a place of three numbers in the plane
points.nearest([0, 0, 0]);
// @ts-expect-error: a box of the plane, in space
strew.space.points({ bbox: [0, 0, 9, 9], spacing: 1 });
// @ts-expect-error: a ball without a radius
strew.space.points({ ball: [0, 0, 0], spacing: 1 });
// @ts-expect-error: a parameter of the plane, in space
strew.space.points({ ball: [0, 0, 0, 9], spacing: 1, periodic: 3 });
// @ts-expect-error: a name that is misspelled, in space
strew.space.points({ ball: [0, 0, 0, 9], spacng: 1 });
// @ts-expect-error: a place of the plane, in space
strew.space.points({ spacing: 1 }).nearest([0, 0]);
// @ts-expect-error: two amounts
strew.points({ bbox, spacing: 1, density: 2 });
// @ts-expect-error: no amount
strew.points({ bbox });
// @ts-expect-error: no amount in a layer
strew.points({ bbox, layers: [{ name: "trees" }] });
// @ts-expect-error: an amount beside layers that have theirs
strew.points({ bbox, layers: [{ name: "trees", spacing: 1 }], spacing: 2 });
// @ts-expect-error: two regions
strew.points({ bbox, polygon: [[0, 0], [9, 0], [0, 9]], spacing: 1 });
// @ts-expect-error: a period of a region
strew.points({ bbox, periodic: 5, spacing: 1 });
// @ts-expect-error: two regions
forest.within({ bbox, circle: [0, 0, 1] });
// @ts-expect-error: no region
forest.within({});
// @ts-expect-error: the whole plane has no array of its points
forest.xy();
// @ts-expect-error: the whole plane has no count
strew.points({ count: 5 });
// @ts-expect-error: a column with a name that is misspelled
points.column("angel");
// @ts-expect-error: a column of numbers has no names
points.codes("angle");
// @ts-expect-error: the number of neighbors, of Rust's call
points.nearest([1, 2], 5);
// @ts-expect-error: neighbors with a name that is misspelled
points.nearest([1, 2], { kk: 3 });
// @ts-expect-error: two amounts, in space
strew.space.points({ ball: [0, 0, 0, 9], spacing: 1, density: 2 });
// @ts-expect-error: two regions, in space
strew.space.points({ ball: [0, 0, 0, 9], bbox: [0, 0, 0, 9, 9, 9], spacing: 1 });
// @ts-expect-error: the whole space has no array of its points
strew.space.points({ spacing: 1 }).xyz();
// @ts-expect-error: no map, where the table is not that of map m
lite.points({ bbox, spacing: 1 });
// @ts-expect-error: the map of another table
lite.points({ bbox, spacing: 1, map: "m" });
// @ts-expect-error: two amounts, in strew/lite
lite.points({ bbox, spacing: 1, density: 2, map: "s" });
// @ts-expect-error: the whole plane has no array of its points
lite.points({ spacing: 1, map: "s" }).xy();
// @ts-expect-error: what strew/lite does not know
lite.points({ bbox, map: "s", spacing: 1, field: "forest" });
// @ts-expect-error: no formats in strew/lite
lite.points({ bbox, map: "s", spacing: 1 }).document("csv");
// @ts-expect-error: an option of `open` that is misspelled
open({ table: ["blue-5-sqrt3-over-2-m.strew"] });
// @ts-expect-error: an option of chunks that is misspelled
new Chunks(lite.points({ map: "s", spacing: 2 }), [], { size: 64 });
