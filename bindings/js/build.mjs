// Builds the two modules of WebAssembly, copies the tables beside them, has the names and types of parameters printed, and
// writes the package of all other tables.
import { execFileSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { basename } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = (/** @type {string} */ path) => fileURLToPath(new URL(path, import.meta.url));
const target = process.env.CARGO_TARGET_DIR ?? here("../target");
const TARGET = "wasm32-unknown-unknown";

/** Binaryen's wasm-opt: of the development dependency, else of the machine. */
function optimizer() {
    const own = here("node_modules/binaryen/bin/wasm-opt");
    return existsSync(own) ? [process.execPath, own] : ["wasm-opt"];
}

/**
 * Builds a crate by its profile as a module. Features of WebAssembly are those that it is compiled for.
 * @type {(manifest: string, crate: string, profile: string, module: string, features: string[], more?: string[]) => void}
 */
function built(manifest, crate, profile, module, features, more = []) {
    const flags = `${process.env.RUSTFLAGS ?? ""} -C target-feature=${features.map((name) => `+${name}`).join()}`.trim();
    const how = ["--lib", "--profile", profile, "--target", TARGET, "--manifest-path", here(manifest)];
    execFileSync("cargo", ["build", "--locked", ...how], {
        stdio: "inherit",
        env: { ...process.env, RUSTFLAGS: flags, CARGO_TARGET_DIR: target },
    });
    const from = `${target}/${TARGET}/${profile}/${crate}.wasm`;
    const known = ["nontrapping-float-to-int", "sign-ext", "mutable-globals", "multivalue", "reference-types"];
    const enabled = [...known, ...features.map((name) => name.replace("128", ""))].map((name) => `--enable-${name}`);
    const [program, ...first] = optimizer();
    const options = [...first, "-Oz", "--strip-debug", "--strip-producers", ...enabled, ...more, from, "-o", module];
    try {
        execFileSync(program, options, { stdio: "inherit" });
        console.log(`${basename(module)}: wasm-opt ${statSync(from).size} to ${statSync(module).size} bytes`);
    } catch (error) {
        if (/** @type {NodeJS.ErrnoException} */ (error).code !== "ENOENT") throw error;
        throw new Error("wasm-opt is missing: run `npm install` here, which installs binaryen", { cause: error });
    }
}

mkdirSync(here("lib/tables"), { recursive: true });
mkdirSync(here("lib/embedded"), { recursive: true });
built("../c/Cargo.toml", "strew_c", "wasm", here("lib/strew.wasm"), ["simd128", "bulk-memory"]);
// Without vectors it is smaller by 8 kB, and has the same bits; it only takes square roots by them.
built("lite/Cargo.toml", "strew_lite", "lite", here("lib/lite.wasm"), ["bulk-memory"], ["--enable-simd"]);

// The tables of this package, and all of them in a package of their own, each with a module that bundlers understand.
const OWN = ["blue-5-sqrt3-over-2-m.strew", "blue-5-sqrt3-over-2-s.strew", "space-blue-5-sqrt3-over-2-r16.strew"];
for (const old of readdirSync(here("lib/tables"))) rmSync(here(`lib/tables/${old}`));
rmSync(here("tables/files"), { recursive: true, force: true });
mkdirSync(here("tables/files"), { recursive: true });
const shipped = ["", "space/"].map((folder) => `../../crates/catalog/tables/${folder}`);
for (const folder of ["../../crates/core/tables/", "../../crates/core/tables/joint/", ...shipped]) {
    for (const file of readdirSync(here(folder)).filter((name) => name.endsWith(".strew"))) {
        // Tables in space are named as such.
        const name = folder.endsWith("/space/") ? `space-${file}` : file;
        if (OWN.includes(name)) copyFileSync(here(folder + file), here(`lib/tables/${name}`));
        const stem = name.replace(/\.strew$/, "");
        copyFileSync(here(folder + file), here(`tables/files/${name}`));
        const url = `new URL("./${name}", import.meta.url)`;
        writeFileSync(here(`tables/files/${stem}.js`), `// The address of a table.\nexport default ${url};\n`);
        writeFileSync(here(`tables/files/${stem}.d.ts`), "declare const table: URL;\nexport default table;\n");
    }
}

/** A module of files in base64 of gzip. */
function embedded(/** @type {string} */ module, /** @type {string[]} */ files) {
    const line = (/** @type {string} */ file) => {
        const name = basename(file).replace(/\.\w+$/, "").replaceAll("-", "_");
        return `export const ${name} = "${gzipSync(readFileSync(here(file)), { level: 9 }).toString("base64")}";\n`;
    };
    writeFileSync(here(module), `// Files in base64 of gzip.\n${files.map(line).join("")}`);
}

embedded("lib/embedded/full.js", ["lib/strew.wasm", `lib/tables/${OWN[0]}`]);
embedded("lib/embedded/lite.js", ["lib/lite.wasm", `lib/tables/${OWN[1]}`]);

// The program has the table of parameters.
for (const [form, file] of [["js", "parameters.js"], ["dts", "parameters.d.ts"]]) {
    const how = ["run", "--locked", "-q", "--manifest-path", here("../../Cargo.toml"), "--bin", "strew", "--", "parameters"];
    writeFileSync(here(`lib/${file}`), execFileSync("cargo", [...how, "--as", form]));
}
