// Fields from arrays: pixels as JSON has them.

function base64(/** @type {Uint8Array} */ bytes) {
    let text = "";
    for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
    return btoa(text);
}

/**
 * Pixels, the terrain of `height` and `slope` fields: rows from the top, where y is greatest. `where` has `bbox`,
 * `edges`, `filter` and the other members of JSON's pixels. @type {typeof import("./index.js").pixels}
 */
export function pixels(values, width, height, where = {}) {
    if (values.length !== width * height) {
        throw new RangeError(`${width} × ${height} pixels are ${width * height} numbers, not ${values.length}`);
    }
    // Little-endian, as WebAssembly's own memory.
    const bytes = new Uint8Array(4 * values.length);
    const view = new DataView(bytes.buffer);
    for (let i = 0; i < values.length; i++) view.setFloat32(4 * i, values[i], true);
    return { f32: base64(bytes), width, height, ...where };
}

/** A field of shares of the density, 0 to 1; of bytes, 255 is 1. @type {typeof import("./index.js").raster} */
export function raster(values, width, height, where = {}) {
    const isBytes = values instanceof Uint8Array || values instanceof Uint8ClampedArray;
    return { raster: pixels(isBytes ? Float32Array.from(values, (v) => v / 255) : values, width, height, where) };
}
