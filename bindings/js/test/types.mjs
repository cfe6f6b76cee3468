// The types of the package: node test/types.mjs compiles types.ts against it, and refuses its JavaScript where types in
// comments are wrong or missing.
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "strew-types-"));
const npm = (...words) => execFileSync("npm", words, { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });

try {
    writeFileSync(join(folder, "package.json"), '{ "private": true, "type": "module" }');
    const packages = ["typescript@5", "@types/node@20", "@types/three@0.179"];
    npm("install", "--silent", "--no-audit", "--no-fund", "--prefer-offline", ...packages);
    const modules = join(folder, "node_modules");
    for (const [name, from] of [["strew", ".."], ["strew-tables", "../tables"]]) {
        mkdirSync(join(modules, name));
        for (const part of ["package.json", from === ".." ? "lib" : "files"]) {
            cpSync(here(`${from}/${part}`), join(modules, name, part), { recursive: true });
        }
    }
    for (const part of ["types.ts", "../build.mjs", "../lib"]) {
        cpSync(here(part), join(folder, basename(part)), { recursive: true });
    }
    const code = readdirSync(join(folder, "lib")).filter((name) => name.endsWith(".js")).map((name) => `lib/${name}`);
    const target = ["--lib", "esnext,dom", "--target", "esnext", "--module", "esnext", "--moduleResolution", "bundler"];
    const tsc = [join(modules, "typescript/bin/tsc"), "--strict", "--checkJs", "--noEmit", ...target];
    execFileSync(process.execPath, [...tsc, "types.ts", "build.mjs", ...code], { cwd: folder, stdio: "inherit" });
    console.log("the types compile, and refuse what is wrong");
} finally {
    rmSync(folder, { recursive: true, force: true });
}
