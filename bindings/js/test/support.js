// Shared by tests: the package with all tables, and a real daemon.
import { spawn } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

import { open } from "../lib/index.js";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** All tables that the daemon has. */
export const ALL = readdirSync(here("../tables/files"))
    .filter((name) => name.endsWith(".strew"))
    .map((name) => new URL(`../tables/files/${name}`, import.meta.url));

export const whole = () => open({ tables: ALL });

/** A daemon's address and what ends or kills it; undefined where the program is not built. */
export async function daemon(listen = "127.0.0.1:0") {
    const program = process.env.STREW_BIN ?? here("../../../target/debug/strew");
    if (!existsSync(program)) return undefined;
    // The daemon refuses variables that are no settings.
    const env = Object.fromEntries(Object.entries(process.env).filter(([name]) => !name.startsWith("STREW_")));
    const running = spawn(program, ["serve", "--listen", listen], { stdio: ["ignore", "pipe", "ignore"], env });
    const ended = new Promise((resolve) => running.on("exit", resolve));
    const kill = () => (running.kill("SIGKILL"), ended);
    for await (const line of createInterface(running.stdout)) {
        return { url: line.replace("listening on ", "").trim(), end: () => running.kill(), kill };
    }
    throw new Error("the daemon does not listen");
}
