/// <reference lib="esnext.disposable" />

import type { Neighbors, Numbers, Output, Parameters, Regions } from "./parameters.js";
export type { Neighbors, Numbers, Output, Parameters, Regions };

/** The regions that are keywords. */
export interface Shapes extends Regions {
    /** Size, column, row of a square of the world grid; coordinates are relative to its corner. */
    chunk?: Numbers | object | null;
    /** Any region as JSON has it. */
    region?: object | null;
}

/** The keywords of a query: the members of REST's JSON, and the shapes of regions by themselves. */
export interface Query extends Shapes, Parameters {
    /** Several sets at once. */
    layers?: object[];
    [member: string]: unknown;
}

/** One thing that is wrong with a query. */
export interface Fault {
    field: string;
    value: string | null;
    detail: string;
    allowed: string;
}

/** A query that has no answer; `message` has the words of REST. */
export class StrewError extends Error {
    /** As in REST's problem types: invalid-query, too-many-points, … */
    readonly kind: string;
    /** Everything that is wrong with an invalid query. */
    readonly faults: Fault[];
    constructor(message: string, kind?: string, faults?: Fault[]);
}

/** A point of a set, with its attributes by name. */
export interface Point {
    /** Its stable id. */
    id: string;
    x: number;
    y: number;
    /** How far it is from the place whose neighbors were wanted. */
    distance?: number;
    [attribute: string]: unknown;
}

/** A value now, in process, or later, from a daemon. */
export type Answer<Where extends "here" | "there", T> = Where extends "here" ? T : Promise<T>;

/** The points of a query, made when they are wanted. */
export class PointSet<Where extends "here" | "there" = "here"> implements Iterable<Point> {
    private constructor();
    /** The body of `POST /v1/points:query`. */
    readonly body: Record<string, unknown>;
    /** The exact number of points: a number, or a bigint from 2⁵³ on. */
    count(): Answer<Where, number | bigint>;
    /** The query with everything filled in. Integers from 2⁵³ on are bigints. */
    resolved(): Answer<Where, Record<string, unknown>>;
    /** x and y of each point, by turns. */
    xy(): Answer<Where, Float64Array>;
    /** The coordinates as `f32`, relative to the lower corner of the region. */
    xyF32(): Answer<Where, { xy: Float32Array; origin: [number, number] }>;
    /** The place that the coordinates of `xy()` are relative to: the corner of a chunk, else 0, 0. */
    origin(): Answer<Where, [number, number]>;
    /** Two integers for each point; `x:y` as text. */
    ids(): Answer<Where, BigInt64Array>;
    /** The names of the columns beside ids and coordinates. */
    names(): Answer<Where, string[]>;
    /** Numbers, NaN where a layer lacks them; or names, null where they are lacking. */
    column(name: string): Answer<Where, Float64Array | (string | null)[]>;
    /** A column of names as indices, −1 where it is lacking. */
    codes(name: string): Answer<Where, { codes: Int32Array; names: string[] }>;
    /** The same set in another region. */
    within(shape: Shapes): PointSet<Where>;
    /** The points of a square of the world grid. */
    chunk(size: number, x: number, y: number): PointSet<Where>;
    /** The points in at most `parts` parts of the same size, give or take one. */
    split(parts: number): Answer<Where, PointSet<Where>[]>;
    /** The points nearest to a place, nearest first: one, or `k`, or all within `radius`. */
    nearest(at: Numbers, limits?: Neighbors): Answer<Where, Point[]>;
    /** The point of an id. */
    point(id: string): Answer<Where, Point>;
    /** The points in a format of REST, as bytes. */
    document(format: string, options?: Output): Answer<Where, Uint8Array>;
    /** The points one by one; in process only. */
    [Symbol.iterator](): Iterator<Point>;
    /** Releases the memory of the points at once. A set that is used afterwards makes them again. */
    free(): void;
    /** Frees the set at the end of a `using` block, where the platform has `Symbol.dispose`. */
    [Symbol.dispose](): void;
}

/** Where points come from. */
export class Source<Where extends "here" | "there" = "here"> {
    protected constructor();
    /** The points of a query by its keywords. */
    points(query: Query): PointSet<Where>;
    /** The points of a query in JSON, the body of `POST /v1/points:query`. */
    query(body: object): PointSet<Where>;
}

/** The tables that are loaded by default. */
export const DEFAULT_TABLES: string[];

/** Loads the module and tables: names of this package's files, addresses, or bytes. */
export function open(options?: {
    tables?: (string | URL | ArrayBuffer | ArrayBufferView)[];
    wasm?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;
}): Promise<Source<"here">>;

/** A daemon that cannot be reached, or whose answers break off again and again. */
export class Disconnected extends Error {}

/**
 * A daemon, with the functions of what `open` returns; its answers are promises. Several replicas are a list, or one
 * text with commas. A request goes to the one with the fewest requests of this client; an address that fails is left
 * out for a while, and an answer that breaks off continues at any of them, each point once.
 */
export function connect(
    url: string | URL | (string | URL)[],
    options?: {
        key?: string;
        /** How often each address may fail again in a row before a request ends: 3. */
        retries?: number;
        /** For how many seconds after the first failure a request is repeated: 30. */
        patience?: number;
    },
): Source<"there">;

/** Pixels as JSON has them: rows from the top, where y is greatest. */
export function pixels(values: Numbers, width: number, height: number, where?: object): object;

/** A field of an array: shares of the density from 0 to 1; of bytes, 255 is 1. */
export function raster(values: Numbers, width: number, height: number, where?: object): { raster: object };
