// Sets of points, over any source: this page, or a daemon. A daemon's answers are promises.

import { KINDS, WINDOW } from "./parameters.js";
import { OF_ANSWERS, PLANE, SPACE, body, checked, isObject, text } from "./query.js";
import { StrewError, fault } from "./error.js";

/** Rows of coordinates with further columns. */
export function rowsOf({ at, origin }, further) {
    const columns = ["x", "y", ...further.keys()];
    const [each, count] = [columns.length, at.length / 2];
    const values = new Float32Array(each * count);
    for (let i = 0; i < count; i++) {
        values[each * i] = at[2 * i];
        values[each * i + 1] = at[2 * i + 1];
    }
    [...further.values()].forEach((column, k) => column.values.forEach((v, i) => (values[each * i + 2 + k] = v)));
    const named = [...further].filter(([, column]) => column.names).map(([name, column]) => [name, column.names]);
    return { columns, values, names: Object.fromEntries(named), origin };
}

/** Applies a function to a value, or to that of a promise once it is there. */
const after = (value, use) => (value instanceof Promise ? value.then(use) : use(value));

/** Where points come from. */
export class Source {
    /** Whether points are made in this page or process: queries are checked at once, answers are no promises. */
    isLocal = false;

    /** The points of a query by its keywords: `points({ bbox: [0, 0, 10, 10], spacing: 1, seed: 7 })`. */
    points(keywords) {
        return this.query(body(keywords));
    }

    /** The points of a query in JSON, the body of `POST /v1/points:query`. */
    query(query) {
        return PointSet.of(this, query);
    }

    /** Points in space: `space.points({ ball: [0, 0, 0, 9], spacing: 1 })`. */
    get space() {
        return new Space(this);
    }
}

/** Points in space, over a source. */
export class Space {
    #source;

    constructor(source) {
        this.#source = source;
    }

    /** The points of a query in space by its keywords. */
    points(keywords) {
        return this.query(body(keywords));
    }

    /** The points of a query in JSON, the body of `POST /v1/space/points`. */
    query(query) {
        return SpaceSet.of(this.#source, query);
    }
}

/** The points of a query, made when they are wanted: what sets of the plane and of space have in common. */
class Points {
    #source;
    #body;
    #dimension;
    #plan;
    #columns;

    constructor(source, query, dimension) {
        this.#source = source;
        this.#body = { ...query };
        this.#dimension = dimension;
    }

    /** The points of a query, which is checked at once where that takes no request. */
    static of(source, query) {
        const set = new this(source, checked(query));
        if (source.isLocal && "region" in query) set.plan();
        return set;
    }

    /** The body of `POST /v1/points:query`, in space of `POST /v1/space/points`. */
    get body() {
        return { ...this.#body };
    }

    /** The planned query of the set. */
    plan() {
        const isThere = this.#plan && !this.#plan.isFree;
        if (!isThere) this.#plan = this.#source.plan(text(this.#body), this.#body, this.#dimension);
        return this.#plan;
    }

    /** Releases the memory of the points. A set that is used afterwards makes them again. */
    free() {
        this.#plan?.free();
        this.#plan = this.#columns = undefined;
    }

    /** The exact number of points: a number, or a bigint from 2⁵³ on. */
    count() {
        return this.plan().count();
    }

    /** The query with everything filled in. */
    resolved() {
        return this.plan().resolved();
    }

    /** The coordinates of each point, by turns. */
    _coordinates() {
        return this.#columns ? after(this.#columns, (columns) => columns.at) : this.plan().coordinates();
    }

    /** The place that coordinates are relative to: the corner of a chunk, else the origin of the world. */
    origin() {
        return this.plan().origin();
    }

    /** The ids: two integers for each point in a BigInt64Array, `x:y` as text; in space three, `x:y:z`. */
    ids() {
        return after(this.#all(), (columns) => columns.ids);
    }

    #all() {
        if (this.#columns) return this.#columns;
        const columns = this.plan().columns();
        this.#columns = columns;
        // After a failure the next call requests them again.
        if (columns instanceof Promise) {
            columns.catch(() => {
                if (this.#columns === columns) this.#columns = undefined;
            });
        }
        return columns;
    }

    /** The names of the columns beside ids and coordinates. */
    names() {
        return after(this.#all(), (columns) => [...columns.further.keys()]);
    }

    #further(name) {
        return after(this.#all(), ({ further }) => {
            const column = further.get(name);
            if (column) return column;
            const known = [...this.#dimension.axes, ...further.keys()].join(", ");
            throw new RangeError(`no column ${JSON.stringify(name)}; there are ${known}`);
        });
    }

    /** Numbers in a Float64Array, NaN where a layer lacks them; or a list of names, null where they are lacking. */
    column(name) {
        const [axes, axis] = [this.#dimension.axes.length, [...this.#dimension.axes].indexOf(name)];
        if (axis >= 0) {
            const each = (at) => Float64Array.from({ length: at.length / axes }, (_, i) => at[axes * i + axis]);
            return after(this._coordinates(), each);
        }
        return after(this.#further(name), ({ values, names }) =>
            names ? Array.from(values, (code) => names[code] ?? null) : values,
        );
    }

    /** A column of names as indices, −1 where it is lacking: `{ codes, names }`. */
    codes(name) {
        return after(this.#further(name), ({ values, names }) => {
            if (!names) throw new RangeError(`${JSON.stringify(name)} is a column of numbers`);
            return { codes: values, names };
        });
    }

    #with(members) {
        const query = { ...this.#body, ...members };
        for (const [name, value] of Object.entries(members)) if (value === undefined) delete query[name];
        return this.constructor.of(this.#source, query);
    }

    /** The same set in another region: `within({ bbox: [0, 0, 5, 5] })`. */
    within(shape) {
        const { region } = body(shape);
        if (!region) throw new TypeError(`within takes one of region, ${this.#dimension.shapes.join(", ")}`);
        return this.#with({ region, ...Object.fromEntries(WINDOW.map((name) => [name, undefined])) });
    }

    /** The points in at most `parts` parts of the same size, give or take one. A part's `body` can go to a worker. */
    split(parts) {
        const made = ({ cursor, limit }) => this.#with({ cursor, limit, offset: undefined });
        return after(this.plan().split(parts), (places) => places.map(made));
    }

    #set(more) {
        const values = { ...more, ...this.#body };
        for (const name of OF_ANSWERS) delete values[name];
        const isOfRegion = "count" in values && "region" in this.#body;
        if (isOfRegion) delete values.count;
        let ready = isOfRegion ? after(this.resolved(), ({ spacing }) => void (values.spacing = spacing)) : undefined;
        // An address has no room for fields: it names them.
        for (const name of Object.keys(values).filter((name) => KINDS[name] === "field" && isObject(values[name]))) {
            const hold = () => this.#source.holdField(text(values[name]));
            ready = after(after(ready, hold), (held) => void (values[name] = held));
        }
        return after(ready, () => values);
    }

    /** The points nearest to a place, nearest first: one, or `k`, or all within `radius`. */
    nearest(at, limits = {}) {
        const allowed = "{ k, radius }: the number of points, and how far they are at most";
        if (!isObject(limits)) throw fault("limits", text(limits), "not an object", allowed);
        const { k, radius, ...others } = limits;
        for (const name of Object.keys(others)) throw fault(name, text(others[name]) ?? null, "unknown limit", allowed);
        return after(this.#set({ at, k, radius }), (set) => this.#source.nearest(set, this.#dimension));
    }

    /** The point of an id. */
    point(id) {
        return after(this.#set({}), (set) => this.#source.point(id, set, this.#dimension));
    }

    /** The points in a format of REST, as bytes: `document("csv", { decimals: 2 })`. */
    document(format, options = {}) {
        return this.plan().document({ format, ...options });
    }

    /** The points one by one, as objects with an id, coordinates and attributes; in process only. */
    *[Symbol.iterator]() {
        if (!this.#source.isLocal) {
            throw new StrewError(`a daemon's points come as columns: await points.${this.#dimension.axes}()`);
        }
        const [ids, at, axes] = [this.ids(), this._coordinates(), [...this.#dimension.axes]];
        const columns = this.names().map((name) => [name, this.column(name)]);
        for (let i = 0; i < at.length / axes.length; i++) {
            const first = i * axes.length;
            const point = { id: ids.subarray(first, first + axes.length).join(":") };
            axes.forEach((axis, k) => (point[axis] = at[first + k]));
            for (const [name, values] of columns) point[name] = values[i];
            yield point;
        }
    }
}

/** The points of a query of the plane. */
export class PointSet extends Points {
    constructor(source, query) {
        super(source, query, PLANE);
    }

    /** x and y of each point, by turns: a Float64Array. */
    xy() {
        return this._coordinates();
    }

    /** The coordinates as a Float32Array, relative to an origin: `{ xy, origin }`. */
    xyF32() {
        return after(this.plan().offsets(), ({ at, origin }) => ({ xy: at, origin }));
    }

    /**
     * The points as rows of `f32`, the form of instances: `{ columns, values, names, origin }`. `values` has x and y of
     * each point, relative to the origin, then its attributes; those of names are indices into the lists of `names`.
     */
    rowsF32() {
        return this.plan().rows();
    }

    /** The points of a square of the world grid. Coordinates are relative to its corner, `origin()`. */
    chunk(size, x, y) {
        return this.within({ chunk: [size, x, y] });
    }
}

/** The points of a query in space. */
export class SpaceSet extends Points {
    constructor(source, query) {
        super(source, query, SPACE);
    }

    /** x, y and z of each point, by turns: a Float64Array. */
    xyz() {
        return this._coordinates();
    }

    /** The coordinates as a Float32Array, relative to an origin: `{ xyz, origin }`. */
    xyzF32() {
        return after(this.plan().offsets(), ({ at, origin }) => ({ xyz: at, origin }));
    }

    /** The points of a cube of the world grid. Coordinates are relative to its corner, `origin()`. */
    chunk(size, x, y, z) {
        return this.within({ chunk: [size, x, y, z] });
    }
}

// For `using points = strew.points(…)`, where the platform has it.
if (Symbol.dispose) Points.prototype[Symbol.dispose] = Points.prototype.free;
