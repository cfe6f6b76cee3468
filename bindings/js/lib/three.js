// Instances for three.js: chunks of points around a camera, drawn by distance and freed when they are far.

import { Box3, Frustum, Group, InstancedMesh, Matrix4 } from "three";

const [SHORTEST_PAUSE, LONGEST_PAUSE] = [1000, 60_000]; // milliseconds, after a failure

/**
 * Instanced meshes of a set of points, chunk by chunk. The plane's x and y are three's x and −z. Points have an angle,
 * a scale and a height z where the set has those columns; `variant` chooses among kinds, and `rank` lets a chunk that
 * is far away draw a part of its points, so that no point ever jumps.
 */
export class Chunks {
    /** What the scene takes. */
    group = new Group();
    /** The error of the last request, until one succeeds. */
    error = null;
    /** The points of loaded chunks, and those that the last update drew. */
    loaded = 0;
    drawn = 0;
    /** The chunks that the last update wanted and that are not there yet. */
    missing = 0;
    #chunks = new Map();
    #running = 0;
    #pause = 0;
    #resumes = 0;
    #frustum = new Frustum();
    #box = new Box3();
    #view = new Matrix4();

    /**
     * `points` is a set of the plane, of `open` or `connect`; `kinds` has a list of `[geometry, material]` for each
     * variant, or one list for all points.
     */
    constructor(points, kinds, { side = 32, near = 96, far = 256, height = 16, atOnce = 8 } = {}) {
        Object.assign(this, { points, kinds, side, near, far, height, atOnce });
    }

    /** The number of loaded chunks. */
    get size() {
        return [...this.#chunks.values()].filter(({ meshes }) => meshes).length;
    }

    /**
     * Requests the chunks around a camera, shows those that it sees, and frees the others. `origin` is the place of the
     * plane where the scene has its origin: move it with the camera to keep numbers small.
     */
    update(camera, origin = [0, 0]) {
        const { side, far } = this;
        camera.updateMatrixWorld();
        this.#view.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
        this.#frustum.setFromProjectionMatrix(this.#view);
        const { elements } = camera.matrixWorld;
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
    #distance(at, cell) {
        const beyond = at.map((v, axis) => {
            const low = cell[axis] * this.side;
            return Math.max(low - v, v - low - this.side, 0);
        });
        return Math.hypot(...beyond);
    }

    /** Requests missing chunks, nearest first. */
    #request(at) {
        const [x, y] = at.map((v) => Math.floor(v / this.side));
        const reach = Math.ceil(this.far / this.side);
        const wanted = [];
        this.missing = 0;
        for (let dy = -reach; dy <= reach; dy++) {
            for (let dx = -reach; dx <= reach; dx++) {
                const cell = [x + dx, y + dy];
                const distance = this.#distance(at, cell);
                if (distance > this.far) continue;
                const chunk = this.#chunks.get(cell.join());
                if (!chunk?.meshes) this.missing += 1;
                if (!chunk) wanted.push({ cell, distance });
            }
        }
        if (performance.now() < this.#resumes) return;
        wanted.sort((a, b) => a.distance - b.distance);
        for (const { cell } of wanted.slice(0, Math.max(this.atOnce - this.#running, 0))) this.#load(cell);
    }

    async #load(cell) {
        const key = cell.join();
        const chunk = { cell, group: new Group(), meshes: null, count: 0 };
        this.#chunks.set(key, chunk);
        this.#running += 1;
        try {
            const points = this.points.chunk(this.side, ...cell);
            const rows = await points.rowsF32();
            points.free();
            // It may have been freed meanwhile.
            if (this.#chunks.get(key) === chunk) this.#fill(chunk, rows);
            [this.error, this.#pause] = [null, 0];
        } catch (error) {
            // A later update requests it again.
            if (this.#chunks.get(key) === chunk) this.#chunks.delete(key);
            this.error = error;
            if (performance.now() < this.#resumes) return;
            this.#pause = Math.min(Math.max(2 * this.#pause, SHORTEST_PAUSE), LONGEST_PAUSE);
            this.#resumes = performance.now() + this.#pause;
        } finally {
            this.#running -= 1;
        }
    }

    #fill(chunk, { columns, values, names }) {
        const each = columns.length;
        const place = Object.fromEntries(columns.map((name, i) => [name, i]));
        const rows = Array.from({ length: values.length / each }, (_, i) => values.subarray(i * each, (i + 1) * each));
        // Those that stay when points are thinned come first.
        if ("rank" in place) rows.sort((a, b) => a[place.rank] - b[place.rank]);
        chunk.meshes = [];
        chunk.count = rows.length;
        const kinds = Array.isArray(this.kinds) ? [[null, this.kinds]] : Object.entries(this.kinds);
        for (const [name, parts] of kinds) {
            const isOwn = (row) => name === null || names.variant?.[row[place.variant]] === name;
            const own = rows.filter(isOwn);
            const ranks = "rank" in place ? own.map((row) => row[place.rank]) : null;
            for (const [geometry, material] of own.length ? parts : []) {
                const mesh = new InstancedMesh(geometry, material, own.length);
                own.forEach((row, i) => write(mesh.instanceMatrix.array, 16 * i, row, place));
                // Chunks are culled as a whole.
                mesh.frustumCulled = false;
                chunk.meshes.push({ mesh, ranks });
                chunk.group.add(mesh);
            }
        }
        this.group.add(chunk.group);
    }

    #show(chunk, distance, origin) {
        const { side, near, far, height } = this;
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
        for (const { mesh, ranks } of chunk.meshes) {
            mesh.count = ranks && share < 1 ? below(ranks, share) : mesh.instanceMatrix.count;
        }
        this.drawn += Math.round(chunk.count * share);
    }

    #free(key, chunk) {
        this.#chunks.delete(key);
        this.group.remove(chunk.group);
        for (const { mesh } of chunk.meshes ?? []) mesh.dispose();
    }

    /** Frees all chunks. Geometries and materials stay their owner's. */
    dispose() {
        for (const [key, chunk] of this.#chunks) this.#free(key, chunk);
    }
}

/** The number of sorted ranks below a share. */
function below(ranks, share) {
    let [low, high] = [0, ranks.length];
    while (low < high) {
        const middle = (low + high) >> 1;
        if (ranks[middle] < share) low = middle + 1;
        else high = middle;
    }
    return low;
}

/** Writes the matrix of a point: turned about three's y, scaled, and moved. */
function write(out, at, row, place) {
    const size = "scale" in place ? row[place.scale] : 1;
    const angle = "angle" in place ? row[place.angle] : 0;
    const [cos, sin] = [size * Math.cos(angle), size * Math.sin(angle)];
    const z = "z" in place ? row[place.z] : 0;
    out.set([cos, 0, -sin, 0, 0, size, 0, 0, sin, 0, cos, 0, row[place.x], z, -row[place.y], 1], at);
}
