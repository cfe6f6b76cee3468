// Builds lib/strew.wasm from bindings/c and copies the tables beside it. With Binaryen's wasm-opt, as a program or as
// the npm package `binaryen`, the module is made smaller.
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readdirSync, statSync } from "node:fs";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const target = process.env.CARGO_TARGET_DIR ?? here("../c/target");
const TARGET = "wasm32-unknown-unknown";

const flags = `${process.env.RUSTFLAGS ?? ""} -C target-feature=+simd128,+bulk-memory`.trim();
execFileSync(
    "cargo",
    ["build", "--locked", "--lib", "--profile", "wasm", "--target", TARGET, "--manifest-path", here("../c/Cargo.toml")],
    { stdio: "inherit", env: { ...process.env, RUSTFLAGS: flags, CARGO_TARGET_DIR: target } },
);
const module = here("lib/strew.wasm");
copyFileSync(`${target}/${TARGET}/wasm/strew_c.wasm`, module);
const before = statSync(module).size;
try {
    const features = ["simd", "bulk-memory", "nontrapping-float-to-int", "sign-ext", "mutable-globals"];
    const enabled = [...features, "multivalue", "reference-types"].map((feature) => `--enable-${feature}`);
    execFileSync("wasm-opt", ["-Oz", ...enabled, module, "-o", module], { stdio: "inherit" });
    console.log(`wasm-opt: ${before} to ${statSync(module).size} bytes`);
} catch (error) {
    if (error.code !== "ENOENT") throw error;
    console.log(`${before} bytes; wasm-opt is not installed`);
}

mkdirSync(here("lib/tables"), { recursive: true });
const shipped = ["", "space/"].map((folder) => `../../crates/catalog/tables/${folder}`);
for (const folder of ["../../crates/core/tables/", "../../crates/core/tables/joint/", ...shipped]) {
    for (const file of readdirSync(here(folder)).filter((name) => name.endsWith(".strew"))) {
        // Tables in space are named as such.
        const name = folder.endsWith("/space/") ? `space-${file}` : file;
        copyFileSync(here(folder + file), here(`lib/tables/${name}`));
    }
}
