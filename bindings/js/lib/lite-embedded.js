// strew/lite with its module and its table in the code: for esbuild, and for programs of a single file.

import { blue_5_sqrt3_over_2_s as file, lite as module } from "./embedded/lite.js";
import { unpacked } from "./files.js";
import { open as opened } from "./lite.js";

export * from "./lite.js";

/** Loads the module and its table from the code. @type {import("./types.js").OpenLite} */
export async function open({ table, wasm } = {}) {
    return opened({ wasm: wasm ?? (await unpacked(module)), table: table ?? (await unpacked(file)) });
}
