// What pages load may not grow unseen: each file, compressed, is at most 3 % larger than the README states.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { brotliCompressSync, gzipSync } from "node:zlib";

test("strew/connect loads no module and no tables", () => {
    const all = new Set();
    const load = (name) => {
        if (all.has(name)) return;
        all.add(name);
        for (const [, next] of String(lib(name)).matchAll(/^\w.* from "\.\/([^"]+)"/gm)) load(next);
    };
    load("connect.js");
    assert.ok(all.has("remote.js") && ![...all].some((name) => /new URL\("\./.test(lib(name))), [...all].join());
});

const lib = (name) => readFileSync(new URL(`../lib/${name}`, import.meta.url));
const README = readFileSync(new URL("../README.md", import.meta.url), "utf8");

for (const [file, name = file] of [
    ["strew.wasm"], ["lite.wasm"],
    ["blue-5-sqrt3-over-2-m.strew", "tables/blue-5-sqrt3-over-2-m.strew"],
    ["blue-5-sqrt3-over-2-s.strew", "tables/blue-5-sqrt3-over-2-s.strew"],
]) {
    test(`${file} is as small as the README states`, () => {
        const row = README.split("\n").find((line) => line.startsWith(`| \`${file}\``));
        const [kB, gzip, brotli] = row.split("|").slice(2).map((cell) => Number(cell.replace(",", "")) * 1000);
        const bytes = lib(name);
        for (const [size, most] of [
            [bytes.length, kB], [gzipSync(bytes, { level: 9 }).length, gzip], [brotliCompressSync(bytes).length, brotli],
        ]) {
            assert.ok(size <= 1.03 * most + 500, `${size} bytes; the README states ${most}`);
        }
    });
}
