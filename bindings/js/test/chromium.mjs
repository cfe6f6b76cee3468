// Headless Chromium over its driver, and a server of a folder: what tests of pages share.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { createInterface } from "node:readline";

const TYPES = { ".js": "text/javascript", ".html": "text/html", ".wasm": "application/wasm" };

/** Serves a folder. A path without a file is the page `fallback`, as on servers of single-page applications, or 404. */
export async function serve(root, fallback) {
    const server = createServer(async ({ url }, response) => {
        const path = new URL(url, "http://page").pathname;
        const name = path.endsWith("/") ? `${path}index.html` : path;
        try {
            const content = await readFile(join(root, name));
            response.setHeader("content-type", TYPES[extname(name)] ?? "application/octet-stream");
            response.end(content);
        } catch {
            if (!fallback) return response.writeHead(404).end();
            response.setHeader("content-type", "text/html");
            response.end(await readFile(join(root, fallback)));
        }
    });
    await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
    return { url: `http://127.0.0.1:${server.address().port}`, end: () => server.close() };
}

/** Opens pages, and returns what each leaves in `document.body.dataset.done`. */
export async function chromium() {
    const driver = spawn("chromedriver", ["--port=0"], { stdio: ["ignore", "pipe", "ignore"] });
    const profile = mkdtempSync(join(tmpdir(), "strew-page-"));
    let port;
    for await (const line of createInterface(driver.stdout)) {
        port = /successfully on port (\d+)/.exec(line)?.[1];
        if (port) break;
    }
    const drive = async (method, path, body) => {
        const response = await fetch(`http://127.0.0.1:${port}${path}`, { method, body: body && JSON.stringify(body) });
        const { value } = await response.json();
        if (value?.error) throw new Error(`${value.error}: ${value.message}`);
        return value;
    };
    const args = ["--headless=new", "--no-sandbox", "--disable-gpu", `--user-data-dir=${profile}`];
    const capabilities = { alwaysMatch: { "goog:chromeOptions": { args } } };
    const session = `/session/${(await drive("POST", "/session", { capabilities })).sessionId}`;
    await drive("POST", `${session}/timeouts`, { script: 60_000 });
    const done = `const shown = arguments[0];
        const look = () => document.body?.dataset.done ? shown(document.body.dataset.done) : requestAnimationFrame(look);
        look();`;
    return {
        async open(url) {
            await drive("POST", `${session}/url`, { url });
            return drive("POST", `${session}/execute/async`, { script: done, args: [] });
        },
        async end() {
            await drive("DELETE", session).catch(() => undefined);
            driver.kill();
            rmSync(profile, { recursive: true, force: true });
        },
    };
}
