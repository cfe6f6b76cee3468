/// <reference lib="esnext.disposable" />

import type { Neighbors, Parameters, Regions, Tuple } from "./parameters.js";
import type { Point, PointSet as Whole, StrewError } from "./index.js";
export { StrewError };

/** The regions that strew/lite knows. */
export interface LiteShapes extends Pick<Regions, "bbox" | "circle"> {
    /** Size, column, row of a square of the world grid; coordinates are relative to its corner. */
    chunk?: Tuple<[size: number, column: number, row: number]> | null;
}

/** The keywords of a query: a part of those of `strew`, with the same points where that has `map: "s"`. */
export interface LiteQuery
    extends LiteShapes,
        Pick<
            Parameters,
            | "density"
            | "spacing"
            | "min_distance"
            | "seed"
            | "warp"
            | "keep"
            | "settle"
            | "lod"
            | "attributes"
            | "scale_range"
            | "variants"
        > {}

/** The points of a query, made when they are wanted. */
export interface PointSet
    extends Omit<Whole<"here">, "within" | "chunk" | "split" | "resolved" | "document" | "nearest" | "point"> {
    /** The same set in another region. */
    within(shape: LiteShapes): PointSet;
    /** The points of a square of the world grid. */
    chunk(size: number, column: number, row: number): PointSet;
    /** The points nearest to a place, nearest first: one, or `k`, or all within `radius`. */
    nearest(at: Tuple<[x: number, y: number]>, limits?: Neighbors): Point[];
    /** The point of an id. */
    point(id: string): Point;
}

/** Where points come from. */
export interface LiteSource {
    /** The points of a query by its keywords. */
    points(query: LiteQuery): PointSet;
}

/** Loads the module and its table: by default of the package, or addresses or bytes. */
export function open(options?: {
    table?: string | URL | ArrayBuffer | ArrayBufferView;
    wasm?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;
}): Promise<LiteSource>;
