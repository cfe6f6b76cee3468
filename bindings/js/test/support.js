// What tests share: the package with all tables, and a real daemon.
import { spawn } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

import { open } from "../lib/index.js";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** All tables that the daemon has. */
export const ALL = readdirSync(here("../lib/tables"));

export const whole = () => open({ tables: ALL });

/** A daemon's address and what ends it; undefined where the program is not built. */
export async function daemon() {
    const program = process.env.STREW_BIN ?? here("../../../target/debug/strew");
    if (!existsSync(program)) return undefined;
    const running = spawn(program, ["serve", "--listen", "127.0.0.1:0"], { stdio: ["ignore", "pipe", "ignore"] });
    for await (const line of createInterface(running.stdout)) {
        return { url: line.replace("listening on ", "").trim(), end: () => running.kill() };
    }
    throw new Error("the daemon does not listen");
}
