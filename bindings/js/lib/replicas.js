// Several daemons with the same points: the choice of the one to call next, and when to try a failed one again.

import { Disconnected } from "./error.js";

// The milliseconds for which a daemon is left out: after its first failure, and at most.
const [SHORTEST, LONGEST] = [100, 5000];

/** A refusal for now, or a connection that broke: another attempt may succeed, after `wait` milliseconds here. */
export class Later extends Error {
    constructor(error, wait = 0) {
        super(error.message, { cause: error });
        this.wait = wait;
    }
}

/** A refusal because of the tables, fields or worlds that a daemon holds: another one may hold others. */
export class Elsewhere extends Error {
    constructor(error) {
        super(error.message, { cause: error });
    }
}

/** The milliseconds of a header `Retry-After`: seconds, or a date. */
export function retryAfter(text) {
    if (/^\d+$/.test(text ?? "")) return 1000 * Number(text);
    return Math.max(0, Date.parse(text) - Date.now()) || 0;
}

/** A daemon and its recent failures. */
class Replica {
    running = 0;
    turn = 0;
    failures = 0;
    until = 0;

    constructor(url) {
        this.url = url;
    }

    pause() {
        const longest = Math.min(SHORTEST * 2 ** Math.min(this.failures - 1, 30), LONGEST);
        return longest * (0.5 + Math.random() / 2);
    }

    answered() {
        this.failures = this.until = 0;
    }

    /** Leaves the daemon out for a while. Requests that fail together count as one failure. */
    failed(wait) {
        const now = performance.now();
        if (now >= this.until) this.failures += 1;
        this.until = Math.max(this.until, now + Math.max(wait, this.pause()));
    }
}

export class Replicas {
    #turns = 0;

    /** `retries` bounds further failures in a row of each daemon, `patience` the seconds after the first failure. */
    constructor(urls, retries, patience) {
        this.all = urls.map((url) => new Replica(url));
        this.retries = retries;
        this.patience = 1000 * patience;
    }

    /** The daemons that are not left out. */
    up() {
        return this.all.filter(({ until }) => until <= performance.now());
    }

    /** The daemon with the fewest requests among those that are up; else the milliseconds until one may be. */
    #take(left, isUrgent) {
        const now = performance.now();
        const up = left.filter(({ until }) => until <= now);
        if (!up.length && !isUrgent) return { wait: Math.min(...left.map(({ until }) => until)) - now };
        const [best] = [...(up.length ? up : left)].sort((a, b) => a.running - b.running || a.turn - b.turn);
        if (best.failures) {
            // Others wait for what this request finds.
            best.failures += 1;
            best.until = now + best.pause();
        }
        best.turn = ++this.#turns;
        return { replica: best };
    }

    /** Calls `work(replica, progress)` until it succeeds or no other attempt may, and returns its result. */
    async attempts(work, { only = this.all, retries = this.retries } = {}) {
        let left = only;
        let [failures, end, last, refusal] = [0];
        const progress = () => {
            [failures, end, last] = [0];
        };
        const isTooLate = (wait) => performance.now() + wait > (end ??= performance.now() + this.patience);
        for (;;) {
            let { replica, wait } = this.#take(left, false);
            if (!replica && !isTooLate(wait)) {
                await new Promise((ready) => setTimeout(ready, wait));
                continue;
            }
            if (!replica) {
                if (refusal ?? last) throw refusal ?? last;
                // Nothing was tried, because other requests failed.
                ({ replica } = this.#take(left, true));
            }
            replica.running += 1;
            try {
                return await work(replica, progress);
            } catch (error) {
                if (error instanceof Elsewhere) {
                    refusal = error.cause;
                    left = left.filter((one) => one !== replica);
                    if (!left.length) throw refusal;
                } else if (error instanceof Later) {
                    replica.failed(error.wait);
                    last = error.cause;
                    failures += 1;
                    if (failures >= (retries + 1) * left.length || isTooLate(0)) throw refusal ?? last;
                } else {
                    throw error;
                }
            } finally {
                replica.running -= 1;
            }
        }
    }
}

/** The error of a connection that broke: another attempt is made. */
export const broken = (replica, cause) =>
    new Later(new Disconnected(`${replica.url}: ${cause.cause?.message ?? cause.message}`, { cause }));
