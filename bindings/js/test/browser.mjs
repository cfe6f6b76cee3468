// The worker example in headless Chromium: node test/browser.mjs. Prints what the page shows.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("..", import.meta.url));
const TYPES = { ".js": "text/javascript", ".html": "text/html", ".wasm": "application/wasm" };
const server = createServer(async ({ url }, response) => {
    try {
        const content = await readFile(join(root, new URL(url, "http://page").pathname));
        response.setHeader("content-type", TYPES[extname(url)] ?? "application/octet-stream");
        response.end(content);
    } catch {
        response.writeHead(404).end();
    }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const page = `http://127.0.0.1:${server.address().port}/examples/worker.html`;

const driver = spawn("chromedriver", ["--port=0"], { stdio: ["ignore", "pipe", "ignore"] });
const profile = mkdtempSync(join(tmpdir(), "strew-page-"));
let port;
for await (const line of createInterface(driver.stdout)) {
    port = /successfully on port (\d+)/.exec(line)?.[1];
    if (port) break;
}

async function drive(method, path, body) {
    const response = await fetch(`http://127.0.0.1:${port}${path}`, { method, body: body && JSON.stringify(body) });
    const { value } = await response.json();
    if (value?.error) throw new Error(`${value.error}: ${value.message}`);
    return value;
}

let session;
try {
    const args = ["--headless=new", "--no-sandbox", "--disable-gpu", `--user-data-dir=${profile}`];
    const capabilities = { alwaysMatch: { "goog:chromeOptions": { args } } };
    session = `/session/${(await drive("POST", "/session", { capabilities })).sessionId}`;
    await drive("POST", `${session}/timeouts`, { script: 60_000 });
    await drive("POST", `${session}/url`, { url: page });
    const done = `const shown = arguments[0];
        const look = () => document.body.dataset.done ? shown(document.body.dataset.done) : requestAnimationFrame(look);
        look();`;
    const shown = await drive("POST", `${session}/execute/async`, { script: done, args: [] });
    console.log(shown);
    // The same sum that Node makes in one go.
    const { open } = await import("../lib/index.js");
    const count = (await open()).points({ bbox: [0, 0, 256, 256], spacing: 2, seed: 5 }).count();
    if (shown !== `${count} points in 16 chunks`) throw new Error(`Node has ${count} points`);
} finally {
    if (session) await drive("DELETE", session).catch(() => undefined);
    driver.kill();
    server.close();
    rmSync(profile, { recursive: true, force: true });
}
