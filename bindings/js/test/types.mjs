// The types of the package: node test/types.mjs compiles types.ts against it, with the compiler of a folder.
// STREW_TSC is the folder of the npm packages typescript and @types/three; without it, they are installed.
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "strew-types-"));
const npm = (...words) => execFileSync("npm", words, { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });

try {
    writeFileSync(join(folder, "package.json"), '{ "private": true, "type": "module" }');
    npm("install", "--silent", "--no-audit", "--no-fund", "--prefer-offline", "typescript@5", "@types/three@0.179");
    const modules = join(folder, "node_modules");
    for (const [name, from] of [["strew", ".."], ["strew-tables", "../tables"]]) {
        mkdirSync(join(modules, name));
        for (const part of ["package.json", from === ".." ? "lib" : "files"]) {
            cpSync(here(`${from}/${part}`), join(modules, name, part), { recursive: true });
        }
    }
    cpSync(here("types.ts"), join(folder, "types.ts"));
    const how = ["--strict", "--noEmit", "--target", "esnext", "--moduleResolution", "bundler", "--module", "esnext"];
    const tsc = [join(modules, "typescript/bin/tsc"), ...how, "--lib", "esnext,dom", "types.ts"];
    execFileSync(process.execPath, tsc, { cwd: folder, stdio: "inherit" });
    console.log("the types compile, and refuse what is wrong");
} finally {
    rmSync(folder, { recursive: true, force: true });
}
