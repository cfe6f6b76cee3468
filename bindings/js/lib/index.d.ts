/// <reference lib="esnext.disposable" />

import type {
    Neighbors,
    Numbers,
    Output,
    Parameters,
    Regions,
    SpaceParameters,
    Tuple,
    VolumeParameters,
} from "./parameters.js";
export type { Neighbors, Numbers, Output, Parameters, Regions, SpaceParameters, Tuple };

/** One of some members; the others are absent, or `None`. */
export type OneOf<Members, None = undefined> = {
    [Name in keyof Members]-?: { [Own in Name]-?: NonNullable<Members[Own]> } & NoneOf<Omit<Members, Name>, None>;
}[keyof Members];

/** None of some members. */
export type NoneOf<Members, None = undefined> = { [Name in keyof Members]?: None | undefined };

/** How densely points lie: a set has one of these. */
export type Amounts = Pick<Parameters, "density" | "spacing" | "min_distance" | "count">;
type Uncounted = OneOf<Omit<Amounts, "count">> & { count?: undefined };

/** The columns of names. */
export type NameColumn = "layer" | "variant";
/** The columns of numbers: coordinates, attributes, and those of a terrain. */
export type NumberColumn =
    | "x" | "y" | "z" | "angle" | "scale" | "rank" | "nx" | "ny" | "nz" | "qx" | "qy" | "qz" | "qw"
    | `u${1 | 2 | 3 | 4 | 5 | 6 | 7 | 8 | 9 | 10 | 11 | 12 | 13 | 14 | 15 | 16}`;

/** The regions that are keywords. */
export interface Shapes extends Regions {
    /** Size, column, row of a square of the world grid; coordinates are relative to its corner. */
    chunk?: Tuple<[size: number, column: number, row: number]> | { size: number; x: number; y: number } | null;
    /** Any region as JSON has it. */
    region?: object | null;
}

/** Members of a document that a body may have. */
type Form = Output & { format?: string };

/** What a layer has beside the parameters of its set. */
interface Named {
    /** Its name. */
    name: string;
    /** The layers whose points it keeps away from, with the least distances. */
    clear_of?: Record<string, number> | readonly object[];
}

/** Parameters of sets, without those of which there is one. */
type Plain<Of> = Omit<Of, keyof Amounts | "periodic">;
type OfSet<Of> = Omit<Plain<Of>, "world" | "world_digest" | "offset" | "limit" | "cursor">;

/** A layer: a set of points with a name. */
export type Layer = Named & OfSet<Parameters> & OneOf<Amounts>;

/** A set of its own, of several layers, or of a world. */
type Sets<One, Amount> =
    | (Amount & { layers?: undefined })
    | (NoneOf<Amounts> & ({ layers: readonly One[] } | { world: string }));

/** Each feature of a collection as a layer, with the properties that hold its name and its number of points. */
interface Features {
    features?: { of: object; id?: string; count?: string };
}
type Places = Shapes & Pick<Parameters, "periodic"> & Features;

/** The keywords of a query without a region: of the whole plane. */
export type Unplaced = Plain<Parameters> & Form & Sets<Layer, Uncounted> & NoneOf<Places, null>;

/** The keywords of a query: the members of REST's JSON, and the shapes of regions by themselves. */
export type Query =
    | Unplaced
    | (Plain<Parameters> & Form & Sets<Layer, OneOf<Amounts>> & OneOf<Places, null>)
    | (Plain<Parameters> & Form & NoneOf<Amounts> & Required<Features> & NoneOf<Omit<Places, "features">, null>);

/** The regions of space that are keywords. */
export interface Volumes extends VolumeParameters {
    /** An upright prism: the vertices of its base, or GeoJSON, the height of its bottom, and of its top. */
    prism?: readonly [Iterable<Numbers>, number, number] | object | null;
    /** Size, x, y, z of a cube of the world grid; coordinates are relative to its corner. */
    chunk?: Tuple<[size: number, x: number, y: number, z: number]> | { size: number; x: number; y: number; z: number } | null;
    /** Any volume as JSON has it. */
    region?: object | null;
}

/** A layer in space. */
export type SpaceLayer = Named & OfSet<SpaceParameters> & OneOf<Amounts>;

/** The keywords of a query in space without a region. */
export type UnplacedSpace = Plain<SpaceParameters> & Form & Sets<SpaceLayer, Uncounted> & NoneOf<Volumes, null>;

/** The keywords of a query in space. */
export type SpaceQuery =
    | UnplacedSpace
    | (Plain<SpaceParameters> & Form & Sets<SpaceLayer, OneOf<Amounts>> & OneOf<Volumes, null>);

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

/** A point in space, with its attributes by name. */
export interface SpacePoint extends Point {
    z: number;
}

/** A value now, in process, or later, from a daemon. */
export type Answer<Where extends "here" | "there", T> = Where extends "here" ? T : Promise<T>;

/** What sets of the plane and of space have in common: `One` is a point, `Regions` are keywords of regions. */
interface Points<Where extends "here" | "there", One, Regions, Place> extends Iterable<One> {
    /** The body of `POST /v1/points:query`, in space of `POST /v1/space/points`. */
    readonly body: Record<string, unknown>;
    /**
     * The exact number of points. It is typed as a number, which it is below 2⁵³; from there on it is a bigint of the
     * same value, so that it is exact: `BigInt(points.count())` is right for both.
     */
    count(): Answer<Where, number>;
    /** The query with everything filled in. Integers from 2⁵³ on are bigints. */
    resolved(): Answer<Where, Record<string, unknown>>;
    /** Two integers for each point, `x:y` as text; in space three, `x:y:z`. */
    ids(): Answer<Where, BigInt64Array>;
    /** The names of the columns beside ids and coordinates. */
    names(): Answer<Where, (NameColumn | NumberColumn)[]>;
    /** Names, null where they are lacking; or numbers, NaN where a layer lacks them. */
    column(name: NameColumn): Answer<Where, (string | null)[]>;
    column(name: NumberColumn): Answer<Where, Float64Array>;
    column(name: NameColumn | NumberColumn): Answer<Where, Float64Array | (string | null)[]>;
    /** A column of names as indices, −1 where it is lacking. */
    codes(name: NameColumn): Answer<Where, { codes: Int32Array; names: string[] }>;
    /** The same set in another region. */
    within(shape: OneOf<Regions, null>): this;
    /** The points in at most `parts` parts of the same size, give or take one. */
    split(parts: number): Answer<Where, this[]>;
    /** The points nearest to a place, nearest first: one, or `k`, or all within `radius`. */
    nearest(at: Place, limits?: Neighbors): Answer<Where, One[]>;
    /** The point of an id. */
    point(id: string): Answer<Where, One>;
    /** The points in a format of REST, as bytes. */
    document(format: string, options?: Output): Answer<Where, Uint8Array>;
    /** The points one by one; in process only. */
    [Symbol.iterator](): Iterator<One>;
    /** Releases the memory of the points at once. A set that is used afterwards makes them again. */
    free(): void;
    /** Frees the set at the end of a `using` block, where the platform has `Symbol.dispose`. */
    [Symbol.dispose](): void;
}

/** The rows of an answer as `f32`, the form of instances. */
export interface Rows {
    /** x and y, then the attributes in the order of the query; names as indices of `names`. */
    columns: string[];
    /** The values of all rows, one row after another. */
    values: Float32Array;
    /** The names that a column's indices stand for. */
    names: Record<string, string[]>;
    /** The place that coordinates are relative to. */
    origin: [number, number];
}

/** The points of a query of the plane, made when they are wanted. */
export interface PointSet<Where extends "here" | "there" = "here"> extends Points<Where, Point, Shapes, Tuple<[x: number, y: number]>> {}
export class PointSet<Where extends "here" | "there" = "here"> {
    private constructor();
    /** x and y of each point, by turns. */
    xy(): Answer<Where, Float64Array>;
    /** The coordinates as `f32`, relative to the lower corner of the region. */
    xyF32(): Answer<Where, { xy: Float32Array; origin: [number, number] }>;
    /** One row for each point: `f32` coordinates relative to `origin`, and the numbers of attributes; see `rowsF32`. */
    rowsF32(): Answer<Where, Rows>;
    /** The place that the coordinates of `xy()` are relative to: the corner of a chunk, else 0, 0. */
    origin(): Answer<Where, [number, number]>;
    /** The points of a square of the world grid. */
    chunk(size: number, x: number, y: number): PointSet<Where>;
}

/** What the set of a query without a region has: `within` and `chunk` are sets whose points can be made. */
export type Whole<Set> = Pick<
    Set,
    keyof Set & ("body" | "within" | "chunk" | "nearest" | "point" | "free" | typeof Symbol.dispose)
>;

/** The points of a query in space, made when they are wanted. */
export interface SpaceSet<Where extends "here" | "there" = "here"> extends Points<Where, SpacePoint, Volumes, Tuple<[x: number, y: number, z: number]>> {}
export class SpaceSet<Where extends "here" | "there" = "here"> {
    private constructor();
    /** x, y and z of each point, by turns. */
    xyz(): Answer<Where, Float64Array>;
    /** The coordinates as `f32`, relative to the lower corner of the region. */
    xyzF32(): Answer<Where, { xyz: Float32Array; origin: [number, number, number] }>;
    /** The place that the coordinates of `xyz()` are relative to: the corner of a chunk, else 0, 0, 0. */
    origin(): Answer<Where, [number, number, number]>;
    /** The points of a cube of the world grid. */
    chunk(size: number, x: number, y: number, z: number): SpaceSet<Where>;
}

/** Points in space. */
export class Space<Where extends "here" | "there" = "here"> {
    private constructor();
    /** The points of a query in space by its keywords. */
    points(query: UnplacedSpace): Whole<SpaceSet<Where>>;
    points(query: SpaceQuery): SpaceSet<Where>;
    /** The points of a query in JSON, the body of `POST /v1/space/points`. */
    query(body: object): SpaceSet<Where>;
}

/** Where points come from. */
export class Source<Where extends "here" | "there" = "here"> {
    protected constructor();
    /** The points of a query by its keywords. */
    points(query: Unplaced): Whole<PointSet<Where>>;
    points(query: Query): PointSet<Where>;
    /** The points of a query in JSON, the body of `POST /v1/points:query`. */
    query(body: object): PointSet<Where>;
    /** Points in space; in process `open` loads their table by its name. */
    readonly space: Space<Where>;
}

/** The tables that are loaded by default. */
export const DEFAULT_TABLES: readonly string[];

/** The table for points in space that a daemon answers with by default: `open({ tables: SPACE_TABLES })`. */
export const SPACE_TABLES: readonly string[];

/**
 * Loads the module and tables: names of this package's files, addresses, or bytes. The package `strew-tables` has the
 * addresses of all others.
 */
export function open(options?: {
    tables?: readonly (string | URL | ArrayBuffer | ArrayBufferView)[];
    wasm?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;
}): Promise<Source<"here">>;

/** A daemon that cannot be reached, or whose answer broke off. */
export class Disconnected extends Error {}

/**
 * A daemon, with the functions of what `open` returns; its answers are promises.
 *
 * Several replicas are a list of addresses, or one text with commas. A request goes to the address that answered last.
 * If the connection fails, or the answer is 503 with `Retry-After`, it is sent once more after that time, at most
 * 5 seconds: to the next address, or to the only one. Then an error names every address tried and why. All other
 * refusals are thrown at once.
 *
 * An answer that breaks off throws `Disconnected`; a set is never shorter than it should be. To continue where long
 * reading ended, read the parts of `split` one by one: each has its own cursor.
 */
export function connect(url: string | URL | (string | URL)[], options?: { key?: string }): Source<"there">;

/** Pixels as JSON has them: rows from the top, where y is greatest. */
export function pixels(values: Numbers, width: number, height: number, where?: object): object;

/** A field of an array: shares of the density from 0 to 1; of bytes, 255 is 1. */
export function raster(values: Numbers, width: number, height: number, where?: object): { raster: object };
