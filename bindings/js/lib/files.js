// Files of the package: bytes of URLs, in pages and in Node, and words for what bundlers and servers do to them.

import { StrewError } from "./error.js";
/** @import { Content } from "./types.js" */

const isNode = typeof process !== "undefined" && Boolean(process.versions?.node);
const MAGIC = [0x00, 0x61, 0x73, 0x6d];

/** Whether a text is an address rather than a name. */
export const isAddress = (/** @type {string} */ text) => /^([a-z]+:)?\/\/|^(blob|data|file):|^\.{0,2}\//i.test(text);

/** The bytes of an address, or of bytes. `option` of `open` replaces them. */
export async function content(/** @type {Content} */ what, /** @type {string} */ option) {
    if (what instanceof ArrayBuffer) return new Uint8Array(what);
    if (ArrayBuffer.isView(what)) return new Uint8Array(what.buffer, what.byteOffset, what.byteLength);
    const url = new URL(what, globalThis.document?.baseURI ?? globalThis.location?.href);
    if (isNode && url.protocol === "file:") {
        // Bundlers for pages must not look for this module.
        const node = ["node:fs", "promises"].join("/");
        /** @type {typeof import("node:fs/promises")} */
        const { readFile } =
            process.getBuiltinModule?.(node) ?? (await import(/* webpackIgnore: true */ /* @vite-ignore */ node));
        return readFile(url).catch((error) => refuse(url, error.message, option));
    }
    const response = await fetched(url, option);
    return new Uint8Array(await response.arrayBuffer());
}

/**
 * Vite's development server moves modules of packages, but not their files: they are where the package is. Literal
 * URLs are of `node_modules/.vite/deps`.
 */
const unmoved = (/** @type {URL} */ { href }) =>
    new URL(href.replace(/\/node_modules\/\.vite\/[^/]+\//, "/node_modules/strew/lib/"));

async function fetched(/** @type {URL} */ url, /** @type {string} */ option) {
    const places = new Set([url.href, unmoved(url).href]);
    let wrong = "";
    for (const place of [...places].reverse()) {
        const response = await fetch(place).catch((error) => refuse(place, error.message, option));
        const isPage = response.headers.get("content-type")?.startsWith("text/html");
        if (response.ok && !isPage) return response;
        wrong = response.ok ? "the server answers with an HTML page" : `HTTP ${response.status}`;
    }
    return refuse(url, wrong, option);
}

/** @type {(url: URL | string, wrong: string, option: string) => never} */
function refuse(url, wrong, option) {
    throw new StrewError(
        `${url}: ${wrong}. The file was not copied with the code: serve it there, pass its URL or its bytes ` +
            `as \`open({ ${option}: … })\`, or import "strew/embedded", which has it in its code`,
        "file-not-found",
    );
}

/** The compiled module of an address, of bytes, or itself. */
export async function compile(/** @type {Content | WebAssembly.Module} */ what, /** @type {string} */ option) {
    if (what instanceof WebAssembly.Module) return what;
    const bytes = await content(what, option);
    if (!MAGIC.every((byte, i) => bytes[i] === byte)) refuse(String(what), "the file is no WebAssembly module", option);
    return WebAssembly.compile(/** @type {BufferSource} */ (bytes));
}

/** The bytes of a text in base64 of gzip. */
export async function unpacked(/** @type {string} */ text) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}
