// The worker example in headless Chromium: node test/browser.mjs. Prints what the page shows.
import { fileURLToPath } from "node:url";

import { open } from "../lib/index.js";
import { chromium, serve } from "./chromium.mjs";

const [server, browser] = await Promise.all([serve(fileURLToPath(new URL("..", import.meta.url))), chromium()]);
try {
    const shown = await browser.open(`${server.url}/examples/worker.html`);
    console.log(shown);
    // The same sum that Node makes in one go.
    const count = (await open()).points({ bbox: [0, 0, 256, 256], spacing: 2, seed: 5 }).count();
    if (shown !== `${count} points in 16 chunks`) throw new Error(`Node has ${count} points`);
} finally {
    await browser.end();
    server.end();
}
