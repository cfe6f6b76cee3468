/// <reference lib="esnext.disposable" />

import type { Neighbors, Parameters, Regions, Tuple } from "./parameters.js";
import type { Amounts, NoneOf, OneOf, Point, PointSet as Full, StrewError, Whole } from "./index.js";
export { StrewError };

/** The regions that strew/lite knows. */
export interface LiteShapes extends Pick<Regions, "bbox" | "circle"> {
    /** Size, column, row of a square of the world grid; coordinates are relative to its corner. */
    chunk?: Tuple<[size: number, column: number, row: number]> | null;
}

/** The names of a table: its profile, alpha and map. */
export type TableNames = Pick<Parameters, "profile" | "alpha" | "map">;

/** The keywords of a query: a part of those of `strew`, with the same points. `Names` are those of the table. */
export type LiteQuery<Names = TableNames> = LiteSet<Names> & (OneOf<LiteShapes, null> | NoneOf<LiteShapes, null>);
type LiteSet<Names> = OneOf<Omit<Amounts, "count">> &
    Pick<Parameters, "seed" | "warp" | "keep" | "settle" | "lod" | "attributes" | "scale_range" | "variants"> &
    Names;

/** The points of a query, made when they are wanted. */
export interface PointSet
    extends Omit<Full<"here">, "within" | "chunk" | "split" | "resolved" | "document" | "nearest" | "point"> {
    /** The same set in another region. */
    within(shape: OneOf<LiteShapes, null>): PointSet;
    /** The points of a square of the world grid. */
    chunk(size: number, column: number, row: number): PointSet;
    /** The points nearest to a place, nearest first: one, or `k`, or all within `radius`. */
    nearest(at: Tuple<[x: number, y: number]>, limits?: Neighbors): Point[];
    /** The point of an id. */
    point(id: string): Point;
}

/** Where points come from. */
export interface LiteSource<Names = TableNames> {
    /** The points of a query by its keywords. */
    points(query: LiteSet<Names> & NoneOf<LiteShapes, null>): Whole<PointSet>;
    points(query: LiteQuery<Names>): PointSet;
}

/** An address, or bytes. */
type File = string | URL | ArrayBuffer | ArrayBufferView;

/**
 * Loads the module and its table, of map s: queries name it, `map: "s"`, since without a map they mean map m. Another
 * table is an address or bytes.
 */
export function open(options?: { wasm?: File | WebAssembly.Module }): Promise<LiteSource<{ map: "s" }>>;
export function open(options: { table: File; wasm?: File | WebAssembly.Module }): Promise<LiteSource>;
