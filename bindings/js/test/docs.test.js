// The first example of docs/web.md runs, and draws the picture that the page shows. UPDATE_GOLDEN=1 keeps a new one.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { test } from "node:test";

const docs = new URL("../../../docs/", import.meta.url);

test("the page for the web draws its picture", async () => {
    const page = readFileSync(new URL("web.md", docs), "utf8");
    const [, program] = /```js\n([^]*?)```/.exec(page);
    const folder = mkdtempSync(join(tmpdir(), "strew-web-"));
    const before = process.cwd();
    try {
        const lite = new URL("../lib/lite.js", import.meta.url).href;
        writeFileSync(join(folder, "dots.mjs"), program.replace('"strew/lite"', JSON.stringify(lite)));
        process.chdir(folder);
        await import(pathToFileURL(join(folder, "dots.mjs")).href);
        const drawn = readFileSync("dots.svg", "utf8");
        const kept = new URL("pictures/trades/dots.svg", docs);
        if (process.env.UPDATE_GOLDEN) writeFileSync(kept, drawn);
        assert.equal(drawn, readFileSync(kept, "utf8"));
    } finally {
        process.chdir(before);
        rmSync(folder, { recursive: true });
    }
});
