// The package with its module and its default table in the code: for esbuild, and for programs of a single file.

import { blue_5_sqrt3_over_2_m as table, strew as module } from "./embedded/full.js";
import { unpacked } from "./files.js";
import { open as opened } from "./local.js";

export * from "./index.js";

/** Loads both from the code; other tables are addresses or bytes. @type {typeof import("./index.js").open} */
export async function open({ tables, wasm } = {}) {
    return opened({ wasm: wasm ?? (await unpacked(module)), tables: tables ?? [await unpacked(table)] });
}
