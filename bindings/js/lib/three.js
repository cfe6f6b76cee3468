// Instances for three.js: chunks of points around a camera, drawn by distance and freed when they are far.

import { Box3, Frustum, Group, InstancedMesh, Matrix4 } from "three";
/** @import { Camera, TypedArray } from "three" */
/** @import { Rows } from "./index.js" */
/** @import { ChunkSource, Chunks as Public, Parts } from "./three.js" */
/** @typedef {readonly [number, number]} Place A place of the plane, or the column and the row of a chunk. */
/** @typedef {{ mesh: InstancedMesh, ranks: number[] | null }} Drawn */
/** @typedef {{ cell: Place, group: Group, meshes: Drawn[] | null, count: number }} Chunk */

const [SHORTEST_PAUSE, LONGEST_PAUSE] = [1000, 60_000]; // milliseconds, after a failure

/** Its public members are documented in three.d.ts. @implements {Public} */
export class Chunks {
    group = new Group();
    error = /** @type {Error | null} */ (null);
    loaded = 0;
    drawn = 0;
    missing = 0;
    #how;
    #chunks = /** @type {Map<string, Chunk>} */ (new Map());
    #running = 0;
    #pause = 0;
    #resumes = 0;
    #frustum = new Frustum();
    #box = new Box3();
    #view = new Matrix4();

    /** @param {ChunkSource} points @param {Parts | Record<string, Parts>} kinds */
    constructor(points, kinds, { side = 32, near = 96, far = 256, height = 16, atOnce = 8 } = {}) {
        this.#how = { points, kinds, side, near, far, height, atOnce };
    }

    get size() {
        return [...this.#chunks.values()].filter(({ meshes }) => meshes).length;
    }

    update(/** @type {Camera} */ camera, /** @type {Place} */ origin = [0, 0]) {
        const { side, far } = this.#how;
        camera.updateMatrixWorld();
        this.#view.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
        this.#frustum.setFromProjectionMatrix(this.#view);
        const { elements } = camera.matrixWorld;
        /** @type {Place} */
        const at = [origin[0] + elements[12], origin[1] - elements[14]];
        this.#request(at);
        this.loaded = this.drawn = 0;
        for (const [key, chunk] of this.#chunks) {
            const distance = this.#distance(at, chunk.cell);
            // A chunk at the edge does not come and go.
            if (distance > far + side) this.#free(key, chunk);
            else if (chunk.meshes) this.#show(chunk, distance, origin);
        }
    }

    /** The distance of a place from the nearest point of a chunk. */
    #distance(/** @type {Place} */ at, /** @type {Place} */ cell) {
        const beyond = at.map((v, axis) => {
            const low = cell[axis] * this.#how.side;
            return Math.max(low - v, v - low - this.#how.side, 0);
        });
        return Math.hypot(...beyond);
    }

    /** Requests missing chunks, nearest first. */
    #request(/** @type {Place} */ at) {
        const [x, y] = at.map((v) => Math.floor(v / this.#how.side));
        const reach = Math.ceil(this.#how.far / this.#how.side);
        /** @type {{ cell: Place, distance: number }[]} */
        const wanted = [];
        this.missing = 0;
        for (let dy = -reach; dy <= reach; dy++) {
            for (let dx = -reach; dx <= reach; dx++) {
                const cell = /** @type {Place} */ ([x + dx, y + dy]);
                const distance = this.#distance(at, cell);
                if (distance > this.#how.far) continue;
                const chunk = this.#chunks.get(cell.join());
                if (!chunk?.meshes) this.missing += 1;
                if (!chunk) wanted.push({ cell, distance });
            }
        }
        if (performance.now() < this.#resumes) return;
        wanted.sort((a, b) => a.distance - b.distance);
        for (const { cell } of wanted.slice(0, Math.max(this.#how.atOnce - this.#running, 0))) this.#load(cell);
    }

    async #load(/** @type {Place} */ cell) {
        const key = cell.join();
        /** @type {Chunk} */
        const chunk = { cell, group: new Group(), meshes: null, count: 0 };
        this.#chunks.set(key, chunk);
        this.#running += 1;
        try {
            const points = this.#how.points.chunk(this.#how.side, ...cell);
            const rows = await points.rowsF32();
            points.free();
            // It may have been freed meanwhile.
            if (this.#chunks.get(key) === chunk) this.#fill(chunk, rows);
            [this.error, this.#pause] = [null, 0];
        } catch (error) {
            // A later update requests it again.
            if (this.#chunks.get(key) === chunk) this.#chunks.delete(key);
            this.error = /** @type {Error} */ (error);
            if (performance.now() < this.#resumes) return;
            this.#pause = Math.min(Math.max(2 * this.#pause, SHORTEST_PAUSE), LONGEST_PAUSE);
            this.#resumes = performance.now() + this.#pause;
        } finally {
            this.#running -= 1;
        }
    }

    #fill(/** @type {Chunk} */ chunk, /** @type {Rows} */ { columns, values, names }) {
        const each = columns.length;
        const place = Object.fromEntries(columns.map((name, i) => [name, i]));
        const rows = Array.from({ length: values.length / each }, (_, i) => values.subarray(i * each, (i + 1) * each));
        // Those that stay when points are thinned come first.
        if ("rank" in place) rows.sort((a, b) => a[place.rank] - b[place.rank]);
        const meshes = (chunk.meshes = /** @type {Drawn[]} */ ([]));
        chunk.count = rows.length;
        /** @type {[string | null, Parts][]} */
        const kinds = Array.isArray(this.#how.kinds) ? [[null, this.#how.kinds]] : Object.entries(this.#how.kinds);
        for (const [name, parts] of kinds) {
            const own = rows.filter((row) => name === null || names.variant?.[row[place.variant]] === name);
            const ranks = "rank" in place ? own.map((row) => row[place.rank]) : null;
            for (const [geometry, material] of own.length ? parts : []) {
                const mesh = new InstancedMesh(geometry, material, own.length);
                own.forEach((row, i) => write(mesh.instanceMatrix.array, 16 * i, row, place));
                // Chunks are culled as a whole.
                mesh.frustumCulled = false;
                meshes.push({ mesh, ranks });
                chunk.group.add(mesh);
            }
        }
        this.group.add(chunk.group);
    }

    #show(/** @type {Chunk} */ chunk, /** @type {number} */ distance, /** @type {Place} */ origin) {
        const { side, near, far, height } = this.#how;
        const { position } = chunk.group;
        position.set(chunk.cell[0] * side - origin[0], 0, origin[1] - chunk.cell[1] * side);
        // Things reach over the edge of their chunk.
        this.#box.min.set(position.x - height, -height, position.z - side - height);
        this.#box.max.set(position.x + side + height, height, position.z + height);
        chunk.group.updateWorldMatrix(true, false);
        this.#box.applyMatrix4(this.group.matrixWorld);
        this.loaded += chunk.count;
        chunk.group.visible = distance <= far && this.#frustum.intersectsBox(this.#box);
        if (!chunk.group.visible) return;
        // The share of points falls with the square of the distance, as their size on the screen does.
        const share = Math.min(1, (near / Math.max(distance, near)) ** 2);
        for (const { mesh, ranks } of chunk.meshes ?? []) {
            mesh.count = ranks && share < 1 ? below(ranks, share) : mesh.instanceMatrix.count;
        }
        this.drawn += Math.round(chunk.count * share);
    }

    #free(/** @type {string} */ key, /** @type {Chunk} */ chunk) {
        this.#chunks.delete(key);
        this.group.remove(chunk.group);
        for (const { mesh } of chunk.meshes ?? []) mesh.dispose();
    }

    dispose() {
        for (const [key, chunk] of this.#chunks) this.#free(key, chunk);
    }
}

/** The number of sorted ranks below a share. */
function below(/** @type {number[]} */ ranks, /** @type {number} */ share) {
    let [low, high] = [0, ranks.length];
    while (low < high) {
        const middle = (low + high) >> 1;
        if (ranks[middle] < share) low = middle + 1;
        else high = middle;
    }
    return low;
}

/**
 * Writes the matrix of a point: turned about three's y, scaled, and moved.
 * @type {(out: TypedArray, at: number, row: Float32Array, place: Record<string, number>) => void}
 */
function write(out, at, row, place) {
    const size = "scale" in place ? row[place.scale] : 1;
    const angle = "angle" in place ? row[place.angle] : 0;
    const [cos, sin] = [size * Math.cos(angle), size * Math.sin(angle)];
    const z = "z" in place ? row[place.z] : 0;
    out.set([cos, 0, -sin, 0, 0, size, 0, 0, sin, 0, cos, 0, row[place.x], z, -row[place.y], 1], at);
}
