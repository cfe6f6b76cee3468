// Chunks around a place: requested once, drawn by distance, forgotten when far.
import * as THREE from "three";

const SIDE = 32; // meters, along each side of a chunk
const NEAR = 3; // chunks within which all points are drawn
const FAR = 8; // chunks that are drawn at all
const [SHORTEST_PAUSE, LONGEST_PAUSE] = [1000, 60_000]; // milliseconds, after a failure
const COLUMNS = { x: 0, y: 1, angle: 2, scale: 3, variant: 4, rank: 5 };
const WIDTH = 6;

export class Chunks {
    group = new THREE.Group();
    error = null;
    loaded = 0;
    drawn = 0;
    #loaded = new Map();
    #pause = 0;
    #resumes = 0;

    constructor(url, kinds) {
        this.kinds = kinds;
        // The names of variants come sorted.
        this.names = Object.keys(kinds).sort();
        this.query = new URLSearchParams({
            spacing: 2.2, seed: 7, attributes: "angle,scale,variant,rank", scale_range: "0.7,1.3",
            variants: "oak:4,pine:2,rock:1", spread: "even", format: "f32",
        });
        this.url = url;
    }

    get size() {
        return this.#loaded.size;
    }

    // Makes sure of the chunks around a place in meters. Returns the origin of the scene: the corner of its chunk.
    around({ x, y }) {
        const [cx, cy] = [Math.floor(x / SIDE), Math.floor(y / SIDE)];
        for (let dy = -2; dy <= FAR; dy++) {
            for (let dx = -FAR; dx <= FAR; dx++) this.#want(cx + dx, cy + dy);
        }
        this.loaded = this.drawn = 0;
        for (const [key, chunk] of this.#loaded) {
            const [dx, dy] = [chunk.cx - cx, chunk.cy - cy];
            if (Math.abs(dx) > FAR + 1 || dy < -3 || dy > FAR + 1) {
                this.#forget(key, chunk);
                continue;
            }
            chunk.group.position.set(dx * SIDE, 0, -dy * SIDE);
            this.#thin(chunk, Math.max(Math.abs(dx), Math.abs(dy)));
        }
        return [cx * SIDE, cy * SIDE];
    }

    async #want(cx, cy) {
        const key = `${cx},${cy}`;
        if (this.#loaded.has(key) || performance.now() < this.#resumes) return;
        const chunk = { cx, cy, group: new THREE.Group(), meshes: [], count: 0 };
        this.#loaded.set(key, chunk);
        this.group.add(chunk.group);
        try {
            const answer = await patient(`${this.url}/v1/chunks/${SIDE}/${cx}/${cy}?${this.query}`);
            this.#fill(chunk, new Float32Array(await answer.arrayBuffer()));
            [this.error, this.#pause] = [null, 0];
        } catch (error) {
            this.error = `The daemon at ${this.url} does not answer: ${error.message}`;
            // The next call after a pause requests it again.
            this.#forget(key, chunk);
            if (performance.now() < this.#resumes) return;
            this.#pause = Math.min(Math.max(2 * this.#pause, SHORTEST_PAUSE), LONGEST_PAUSE);
            this.#resumes = performance.now() + this.#pause;
        }
    }

    #fill(chunk, values) {
        const points = [];
        for (let i = 0; i < values.length; i += WIDTH) points.push(values.subarray(i, i + WIDTH));
        points.sort((a, b) => a[COLUMNS.rank] - b[COLUMNS.rank]);
        chunk.count = points.length;
        this.names.forEach((name, index) => {
            const own = points.filter((point) => point[COLUMNS.variant] === index);
            const ranks = own.map((point) => point[COLUMNS.rank]);
            for (const [geometry, material] of this.kinds[name]) {
                const mesh = new THREE.InstancedMesh(geometry, material, own.length);
                own.forEach((point, i) => mesh.setMatrixAt(i, matrix(point)));
                chunk.meshes.push({ mesh, ranks });
                chunk.group.add(mesh);
            }
        });
    }

    // The share of points that are drawn falls with the square of the distance, as their size on the screen does.
    #thin(chunk, distance) {
        const share = Math.min(1, (NEAR / Math.max(distance, 1)) ** 2);
        this.loaded += chunk.count;
        this.drawn += Math.round(chunk.count * share);
        if (chunk.share === share && chunk.thinned === chunk.meshes.length) return;
        [chunk.share, chunk.thinned] = [share, chunk.meshes.length];
        for (const { mesh, ranks } of chunk.meshes) {
            const after = ranks.findIndex((rank) => rank >= share);
            mesh.count = after < 0 ? ranks.length : after;
        }
    }

    #forget(key, chunk) {
        this.#loaded.delete(key);
        this.group.remove(chunk.group);
        for (const { mesh } of chunk.meshes) mesh.dispose();
    }
}

// An answer, after as many waits as a busy daemon wishes.
async function patient(url) {
    for (;;) {
        const answer = await fetch(url);
        if (answer.ok) return answer;
        const seconds = Number(answer.headers.get("retry-after"));
        if (!seconds) throw new Error(await answer.text());
        await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
    }
}

const UP = new THREE.Vector3(0, 1, 0);

// The plane's x and y are three's x and −z.
function matrix(point) {
    const turn = new THREE.Quaternion().setFromAxisAngle(UP, point[COLUMNS.angle]);
    const size = point[COLUMNS.scale];
    const place = new THREE.Vector3(point[COLUMNS.x], 0, -point[COLUMNS.y]);
    return new THREE.Matrix4().compose(place, turn, new THREE.Vector3(size, size, size));
}
