// The packed packages in new projects of bundlers, without a setting: node test/bundlers.mjs [name …]. Each project is
// installed, built and opened in Chromium, and its points are those of Node.
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

import { open } from "../lib/index.js";
import { chromium, serve } from "./chromium.mjs";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const room = mkdtempSync(join(tmpdir(), "strew-bundlers-"));
const env = { ...process.env, NEXT_TELEMETRY_DISABLED: "1", NO_COLOR: "1", CI: "1" };
const QUERY = { bbox: [-3, -2, 5, 4], spacing: 1, seed: 7 };

/** Imports by the names of the packages, and the numbers of three sets; `entry` is "" or "/embedded". */
const points = (entry, hasTables = true) => `
import { open } from "strew${entry}";
import { open as openLite } from "strew/lite${entry}";
${hasTables ? 'import green from "strew-tables/green-5-sqrt3-over-2-s";' : ""}
const query = ${JSON.stringify(QUERY)};
export async function numbers() {
    const whole = (await open()).points(query).xy();
    const lite = (await openLite()).points({ ...query, map: "s" }).xy();
    const other = ${hasTables ? '(await open({ tables: [green] })).points({ ...query, profile: "green" }).xy()' : "[]"};
    return JSON.stringify([whole, lite, other].map((at) => [...at]));
}
`;
const PAGE = `import { numbers } from "./points.js";
numbers().catch((error) => error.message).then((text) => { document.body.dataset.done = text; });
`;
const html = (script) => `<!doctype html><title>points</title><body>${script}</body>`;

/** What Node has. */
async function expected(hasTables = true) {
    const small = await open({ tables: ["blue-5-sqrt3-over-2-s.strew"] });
    const green = await open({ tables: [new URL("../tables/files/green-5-sqrt3-over-2-s.strew", import.meta.url)] });
    const sets = [(await open()).points(QUERY), small.points({ ...QUERY, map: "s" })];
    const other = hasTables ? [...green.points({ ...QUERY, profile: "green", map: "s" }).xy()] : [];
    return JSON.stringify([...sets.map((set) => [...set.xy()]), other]);
}

function run(folder, program, ...words) {
    const path = join(folder, "node_modules", program);
    return execFileSync(process.execPath, [path, ...words], { cwd: folder, env, stdio: ["ignore", "pipe", "inherit"] });
}

/** A new folder with the packages, the bundler and some files. */
function project(name, packages, files) {
    const folder = join(room, name);
    const all = { "package.json": JSON.stringify({ name, private: true, type: "module" }), ...files };
    for (const [file, content] of Object.entries(all)) {
        mkdirSync(dirname(join(folder, file)), { recursive: true });
        writeFileSync(join(folder, file), content);
    }
    const own = readdirSync(room).filter((file) => file.endsWith(".tgz")).map((file) => join(room, file));
    const words = ["install", "--silent", "--no-audit", "--no-fund", "--prefer-offline", ...own, ...packages];
    execFileSync("npm", words, { cwd: folder, env, stdio: ["ignore", "pipe", "inherit"] });
    return folder;
}

const version = (folder, name) =>
    `${name} ${JSON.parse(readFileSync(join(folder, "node_modules", name, "package.json"))).version}`;

/** A server of a bundler, once it names its address. */
async function started(folder, program, ...words) {
    const path = join(folder, "node_modules", program);
    const running = spawn(process.execPath, [path, ...words], { cwd: folder, env, stdio: ["ignore", "pipe", "inherit"] });
    for await (const line of createInterface(running.stdout)) {
        const url = /https?:\/\/(?:localhost|127\.0\.0\.1):\d+/.exec(line)?.[0];
        if (url) return { url, end: () => running.kill() };
    }
    throw new Error(`${program} did not start`);
}

const browser = await chromium();

async function check(what, url, wanted) {
    const shown = await browser.open(url);
    if (shown !== wanted) throw new Error(`${what}: ${shown.slice(0, 400)}`);
    console.log(`${what}: the points of Node`);
}

async function built(what, folder, out, wanted) {
    const server = await serve(join(folder, out), "index.html");
    try {
        await check(what, `${server.url}/`, wanted);
    } finally {
        server.end();
    }
}

async function running(what, wanted, ...start) {
    const server = await started(...start);
    try {
        await check(what, `${server.url}/`, wanted);
    } finally {
        server.end();
    }
}

const BUNDLERS = {
    async vite() {
        const index = html('<script type="module" src="/page.js"></script>');
        const folder = project("vite", ["vite@8"], { "index.html": index, "page.js": PAGE, "points.js": points("") });
        const [name, vite] = [version(folder, "vite"), "vite/bin/vite.js"];
        run(folder, vite, "build");
        await built(`${name} build`, folder, "dist", await expected());
        await running(`${name} dev`, await expected(), folder, vite, "--port", "0", "--host", "127.0.0.1");
    },
    async webpack() {
        const files = { "src/index.js": PAGE, "src/points.js": points("") };
        const folder = project("webpack", ["webpack@5", "webpack-cli@6"], files);
        run(folder, "webpack/bin/webpack.js", "--mode", "production");
        writeFileSync(join(folder, "dist/index.html"), html('<script src="/main.js"></script>'));
        await built(`${version(folder, "webpack")} build`, folder, "dist", await expected());
    },
    async next() {
        const page = `"use client";
import { useEffect } from "react";
import { numbers } from "./points.js";
export default function Page() {
    useEffect(() => {
        numbers().catch((error) => error.message).then((text) => { document.body.dataset.done = text; });
    }, []);
    return null;
}
`;
        const layout = "export default ({ children }) => <html><body>{children}</body></html>;\n";
        const files = { "app/page.jsx": page, "app/points.js": points(""), "app/layout.jsx": layout };
        const folder = project("next", ["next@16", "react@19", "react-dom@19"], files);
        const [name, next] = [version(folder, "next"), "next/dist/bin/next"];
        for (const [how, words] of [["Turbopack", []], ["webpack", ["--webpack"]]]) {
            run(folder, next, "build", ...words);
            await running(`${name} build by ${how}`, await expected(), folder, next, "start", "-p", "0");
        }
        await running(`${name} dev`, await expected(), folder, next, "dev", "-p", "0");
    },
    async esbuild() {
        const files = { "page.js": PAGE, "points.js": points("/embedded", false), "plain/page.js": PAGE };
        files["plain/points.js"] = points("", false);
        files["node.js"] = 'import { numbers } from "./points.js"; console.log(await numbers());';
        const folder = project("esbuild", ["esbuild@0.28"], files);
        const name = version(folder, "esbuild");
        const program = join(folder, "node_modules/.bin/esbuild");
        const options = { cwd: folder, stdio: "inherit" };
        const bundle = (...words) => execFileSync(program, ["--bundle", "--log-level=error", ...words], options);
        bundle("page.js", "--outfile=dist/page.js");
        writeFileSync(join(folder, "dist/index.html"), html('<script src="/page.js"></script>'));
        await built(`${name} for pages`, folder, "dist", await expected(false));
        bundle("node.js", "--platform=node", "--format=esm", "--outfile=dist/node.mjs");
        const printed = execFileSync(process.execPath, [join(folder, "dist/node.mjs")]).toString().trim();
        if (printed !== (await expected(false))) throw new Error(`${name} for Node: ${printed.slice(0, 400)}`);
        console.log(`${name} for Node: the points of Node`);
        // It copies no files: the words of the error name the way out.
        bundle("plain/page.js", "--format=esm", "--outfile=plain/dist/page.js");
        writeFileSync(join(folder, "plain/dist/index.html"), html('<script type="module" src="/page.js"></script>'));
        const server = await serve(join(folder, "plain/dist"), "index.html");
        const shown = await browser.open(`${server.url}/`);
        server.end();
        if (!/an HTML page.*import "strew\/embedded"/s.test(shown)) throw new Error(`${name}: ${shown.slice(0, 400)}`);
        console.log(`${name} without strew/embedded: an error with the way out`);
    },
};

try {
    for (const from of ["..", "../tables"]) {
        const words = ["pack", "--silent", "--ignore-scripts", "--pack-destination", room];
        execFileSync("npm", words, { cwd: here(from), stdio: ["ignore", "pipe", "inherit"] });
    }
    const wanted = process.argv.length > 2 ? process.argv.slice(2) : Object.keys(BUNDLERS);
    for (const name of wanted) await BUNDLERS[name]();
} finally {
    await browser.end();
    rmSync(room, { recursive: true, force: true });
}
