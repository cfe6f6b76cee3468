// What the modules of the package pass to each other. None of these types is public.

import type { Answer, NameColumn, NumberColumn, Rows, SpacePoint } from "./index.js";
import type { LiteSource } from "./lite.js";

declare module "./parameters.js" {
    export const REGIONS: string[], WINDOW: string[], OUTPUT: string[], KINDS: Record<string, string>;
}

/** Whether answers are made in this page or process, or by a daemon. */
export type Side = "here" | "there";
/** A file: its address, or its bytes. */
export type Content = string | URL | ArrayBuffer | ArrayBufferView;
export type OpenLite = (options?: { table?: Content; wasm?: Content | WebAssembly.Module }) => Promise<LiteSource>;
/** Members of a query. REST, or the module, refuses values that are wrong. */
export type Body = Record<string, unknown>;
/** The plane, or space: the coordinates of points, their regions, and the paths of REST. */
export type Dimension = { axes: string; shapes: string[]; root: string; queries: string };

export type ColumnName = NameColumn | NumberColumn;
/** Numbers, or names by their indices. */
export type Column = { names: null; values: Float64Array } | { names: string[]; values: Int32Array };
export type Further = Map<ColumnName, Column>;
/** An origin has two numbers, in space three. It is `any`, since only public types tell which. */
export type Offsets = { at: Float32Array; origin: any };
export type Columns = { ids: BigInt64Array; at: Float64Array; further: Further };

/** A set of strew/lite: its place in the module, with what is known of it. */
export type LiteSet = { at: number; attributes: ColumnName[]; names: string[] };

/** A planned query, with its points. */
export interface Plan<Where extends Side> {
    readonly isFree?: boolean;
    free(): void;
    count(): Answer<Where, number>;
    resolved(): Answer<Where, Body>;
    coordinates(): Answer<Where, Float64Array>;
    offsets(): Answer<Where, Offsets>;
    origin(): Answer<Where, Offsets["origin"]>;
    columns(): Answer<Where, Columns>;
    rows(): Answer<Where, Rows>;
    split(parts: number): Answer<Where, { cursor: string; limit: number | bigint }[]>;
    document(options: Body): Answer<Where, Uint8Array>;
}

/** What makes points: a module, or a daemon. `z` of points is there in space. */
export interface Backend<Where extends Side> {
    readonly side: Where;
    plan(text: string, query: Body, dimension?: Dimension): Plan<Where>;
    nearest(values: Body, dimension: Dimension): Answer<Where, SpacePoint[]>;
    point(id: string, values: Body, dimension: Dimension): Answer<Where, SpacePoint>;
    holdField(body: string): Answer<Where, string>;
}

/** A kind of array. */
export type Kind<Made> = { new (buffer: ArrayBuffer): Made; readonly BYTES_PER_ELEMENT: number };

type Exports<Of extends string, Value> = Record<Of, (...values: Value[]) => number> & { memory: WebAssembly.Memory };
type OfPlan = "count" | "columns" | "document" | "free" | "origin" | "query" | "resolved" | "split" | `fill_${Filled}`;
type Filled = "codes" | "coordinates" | "coordinates_f32" | "ids" | "numbers";
type Others = "allocate" | "error_document" | "library_hold_field" | "library_of_tables" | "nearest" | "point_by_id";
/** The functions of the C library that the package calls. */
export type Call = `strew_${`plan_${OfPlan}` | `bytes_${"data" | "free" | "length"}` | Others | "release"}`;
export type Calls = Exports<Call, number>;
/** What calls are passed: numbers, and the addresses of copies of the others. */
export type Passed = number | string | ArrayBufferView;
export type Room = (bytes: number) => number;
/** The functions of `lite/`. Those of `Output` make an output of a plan. */
export type LiteOutput = "columns" | "coordinates" | "offsets" | "origin";
export type LiteArea = "chunk" | "within_box" | "within_circle";
export type LiteCall = LiteOutput | LiteArea | "attributes" | "nearest" | "point" | "set" | "table";
type Unfailing = "input" | "output" | "output_length" | "free_output" | "free_plan" | "free_set";
export type LiteCalls = Exports<LiteCall | Unfailing, number | bigint> & { count(plan: number): bigint };
