// Sets of points, over any source: this page, or a daemon, whose answers are promises. Public members are documented in
// index.d.ts.

import { KINDS, WINDOW } from "./parameters.js";
import { OF_ANSWERS, PLANE, SPACE, body, checked, isObject, text } from "./query.js";
import { StrewError, fault } from "./error.js";
/** @import { Answer, NameColumn, Neighbors, SpacePoint } from "./index.js" */
/** @import { Backend, Body, Column, ColumnName, Columns, Dimension, Further, Offsets, Plan, Side } from "./types.js" */

/** Rows of coordinates with further columns. */
export function rowsOf(/** @type {Offsets} */ { at, origin }, /** @type {Further} */ further) {
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

/**
 * Applies a function to a value, or to that of a promise once it is there.
 * @type {<At extends Side, T, U>(value: Answer<At, T>, use: (value: T) => U | Answer<At, U>) => Answer<At, U>}
 */
const after = (/** @type {any} */ value, use) =>
    /** @type {any} No type tells which of them it is. */ (value instanceof Promise ? value.then(use) : use(value));

/** @template {Side} Where */
export class Source {
    constructor(/** @type {Backend<Where>} */ backend) {
        this.backend = backend;
    }

    points(/** @type {object} */ keywords) {
        return this.query(body(keywords));
    }

    query(/** @type {object} */ query) {
        return new PointSet(this.backend, query);
    }

    get space() {
        return new Space(this.backend);
    }
}

/** @template {Side} Where */
export class Space {
    #backend;

    constructor(/** @type {Backend<Where>} */ backend) {
        this.#backend = backend;
    }

    points(/** @type {object} */ keywords) {
        return this.query(body(keywords));
    }

    query(/** @type {object} */ query) {
        return new SpaceSet(this.#backend, query);
    }
}

/** What sets of the plane and of space have in common. @template {Side} Where */
class Points {
    #backend;
    #body;
    #dimension;
    /** @type {Plan<Where> | undefined} */
    #plan;
    /** @type {Answer<Where, Columns> | undefined} */
    #columns;

    /** @param {Backend<Where>} backend @param {object} query @param {Dimension} dimension */
    constructor(backend, query, dimension) {
        this.#backend = backend;
        this.#body = { ...checked(query) };
        this.#dimension = dimension;
        // It is checked at once where that takes no request.
        if (backend.side === "here" && "region" in query) this.plan();
    }

    get body() {
        return { ...this.#body };
    }

    /** The planned query of the set. */
    plan() {
        if (this.#plan && !this.#plan.isFree) return this.#plan;
        return (this.#plan = this.#backend.plan(text(this.#body), this.#body, this.#dimension));
    }

    free() {
        this.#plan?.free();
        this.#plan = this.#columns = undefined;
    }

    // Where the platform lacks it, the name is "undefined".
    [Symbol.dispose]() {
        this.free();
    }

    count() {
        return this.plan().count();
    }

    resolved() {
        return this.plan().resolved();
    }

    /** The coordinates of each point, by turns. */
    _coordinates() {
        return this.#columns ? after(this.#columns, (columns) => columns.at) : this.plan().coordinates();
    }

    origin() {
        return this.plan().origin();
    }

    ids() {
        return after(this.#all(), (columns) => columns.ids);
    }

    #all() {
        const columns = (this.#columns ??= this.plan().columns());
        // After a failure the next call requests them again.
        const forget = () => (this.#columns = this.#columns === columns ? undefined : this.#columns);
        if (columns instanceof Promise) columns.catch(forget);
        return columns;
    }

    names() {
        return after(this.#all(), (columns) => [...columns.further.keys()]);
    }

    #further(/** @type {ColumnName} */ name) {
        return after(this.#all(), ({ further }) => {
            const column = further.get(name);
            if (column) return column;
            const known = [...this.#dimension.axes, ...further.keys()].join(", ");
            throw new RangeError(`no column ${JSON.stringify(name)}; there are ${known}`);
        });
    }

    /** Numbers, or names: public types tell which. @type {(name: ColumnName) => any} */
    column(name) {
        const [axes, axis] = [this.#dimension.axes.length, [...this.#dimension.axes].indexOf(name)];
        if (axis >= 0) return after(this._coordinates(), (at) => at.filter((_, i) => i % axes === axis));
        const named = (/** @type {Column} */ { values, names }) =>
            names ? Array.from(values, (code) => names[code] ?? null) : values;
        return after(this.#further(name), named);
    }

    codes(/** @type {NameColumn} */ name) {
        return after(this.#further(name), ({ values, names }) => {
            if (!names) throw new RangeError(`${JSON.stringify(name)} is a column of numbers`);
            return { codes: values, names };
        });
    }

    #with(/** @type {Body} */ members) {
        /** @type {Body} */
        const query = { ...this.#body, ...members };
        for (const [name, value] of Object.entries(members)) if (value === undefined) delete query[name];
        const Same = /** @type {new (backend: Backend<Where>, query: Body) => this} */ (this.constructor);
        return new Same(this.#backend, query);
    }

    within(/** @type {object} */ shape) {
        const { region } = body(shape);
        if (!region) throw new TypeError(`within takes one of region, ${this.#dimension.shapes.join(", ")}`);
        return this.#with({ region, ...Object.fromEntries(WINDOW.map((name) => [name, undefined])) });
    }

    split(/** @type {number} */ parts) {
        const made = (/** @type {Body} */ place) => this.#with({ ...place, offset: undefined });
        return after(this.plan().split(parts), (places) => places.map(made));
    }

    /** The parameters of a search in this set. @type {(more: Body) => Answer<Where, Body>} */
    #set(more) {
        const values = { ...more, ...this.#body };
        for (const name of OF_ANSWERS) delete values[name];
        const isOfRegion = "count" in values && "region" in this.#body;
        if (isOfRegion) delete values.count;
        const spaced = (/** @type {Body} */ { spacing }) => Object.assign(values, { spacing });
        let ready = /** @type {Answer<Where, Body>} */ (isOfRegion ? after(this.resolved(), spaced) : values);
        // An address has no room for fields: it names them.
        for (const name of Object.keys(values).filter((name) => KINDS[name] === "field" && isObject(values[name]))) {
            const hold = () => this.#backend.holdField(text(values[name]));
            ready = after(after(ready, hold), (held) => Object.assign(values, { [name]: held }));
        }
        return ready;
    }

    nearest(/** @type {ArrayLike<number>} */ at, /** @type {Neighbors & Body} */ limits = {}) {
        const allowed = "{ k, radius }: the number of points, and how far they are at most";
        if (!isObject(limits)) throw fault("limits", text(limits), "not an object", allowed);
        const { k, radius, ...others } = limits;
        for (const name of Object.keys(others)) throw fault(name, text(others[name]) ?? null, "unknown limit", allowed);
        return after(this.#set({ at, k, radius }), (set) => this.#backend.nearest(set, this.#dimension));
    }

    point(/** @type {string} */ id) {
        return after(this.#set({}), (set) => this.#backend.point(id, set, this.#dimension));
    }

    document(/** @type {string} */ format, /** @type {object} */ options = {}) {
        return this.plan().document({ format, ...options });
    }

    *[Symbol.iterator]() {
        if (this.#backend.side !== "here") {
            throw new StrewError(`a daemon's points come as columns: await points.${this.#dimension.axes}()`);
        }
        const here = /** @type {Points<"here">} */ (/** @type {unknown} */ (this));
        const [ids, at, axes] = [here.ids(), here._coordinates(), [...this.#dimension.axes]];
        const columns = here.names().map((name) => [name, here.column(name)]);
        for (let i = 0; i < at.length / axes.length; i++) {
            const first = i * axes.length;
            const point = /** @type {SpacePoint} */ ({ id: ids.subarray(first, first + axes.length).join(":") });
            for (const [k, axis] of axes.entries()) point[axis] = at[first + k];
            for (const [name, values] of columns) point[name] = values[i];
            yield point;
        }
    }
}

/** @template {Side} Where @extends {Points<Where>} */
export class PointSet extends Points {
    constructor(/** @type {Backend<Where>} */ backend, /** @type {object} */ query) {
        super(backend, query, PLANE);
    }

    xy() {
        return this._coordinates();
    }

    xyF32() {
        return after(this.plan().offsets(), ({ at, origin }) => ({ xy: at, origin }));
    }

    rowsF32() {
        return this.plan().rows();
    }

    chunk(/** @type {number} */ size, /** @type {number} */ x, /** @type {number} */ y) {
        return this.within({ chunk: [size, x, y] });
    }
}

/** @template {Side} Where @extends {Points<Where>} */
export class SpaceSet extends Points {
    constructor(/** @type {Backend<Where>} */ backend, /** @type {object} */ query) {
        super(backend, query, SPACE);
    }

    xyz() {
        return this._coordinates();
    }

    xyzF32() {
        return after(this.plan().offsets(), ({ at, origin }) => ({ xyz: at, origin }));
    }

    /** @param {number} size @param {number} x @param {number} y @param {number} z */
    chunk(size, x, y, z) {
        return this.within({ chunk: [size, x, y, z] });
    }
}
