import type { BufferGeometry, Camera, Group, Material } from "three";
import type { Rows } from "./index.js";

/** A set of the plane: of `open`, of `strew/lite`, or of `connect`. */
export interface ChunkSource {
    chunk(size: number, column: number, row: number): { rowsF32(): Rows | Promise<Rows>; free(): void };
}

/** The parts of a thing: each geometry with its material. */
export type Parts = readonly (readonly [BufferGeometry, Material | Material[]])[];

/**
 * Instanced meshes of a set of points, chunk by chunk. The plane's x and y are three's x and −z. Points have an angle,
 * a scale and a height z where the set has those attributes; `variant` chooses among kinds, and `rank` lets a chunk
 * that is far away draw a part of its points, so that no point ever jumps.
 */
export class Chunks {
    constructor(
        points: ChunkSource,
        /** Parts for each variant, or for all points. */
        kinds: Parts | Record<string, Parts>,
        options?: {
            /** The side of a chunk: 32. */
            side?: number;
            /** The distance within which all points are drawn: 96. */
            near?: number;
            /** The distance up to which there are points: 256. */
            far?: number;
            /** The greatest height and reach of a thing: 16. */
            height?: number;
            /** The number of chunks that are requested at once: 8. In process, those of one update. */
            atOnce?: number;
        },
    );
    /** What the scene takes. */
    readonly group: Group;
    /** The error of the last request, until one succeeds. Chunks are requested again after a pause. */
    readonly error: Error | null;
    /** The points of loaded chunks. */
    readonly loaded: number;
    /** The points that the last update drew. */
    readonly drawn: number;
    /** The chunks that the last update wanted and that are not there yet. */
    readonly missing: number;
    /** The number of loaded chunks. */
    readonly size: number;
    /**
     * Requests the chunks around a camera, shows those that it sees, and frees the others. `origin` is the place of the
     * plane where the scene has its origin: move it with the camera to keep numbers small.
     */
    update(camera: Camera, origin?: readonly [number, number]): void;
    /** Frees all chunks. Geometries and materials stay their owner's. */
    dispose(): void;
}
