// Plans in the memory of a module: freed once their sets are collected, and beyond a number of them the oldest first.

import { StrewError } from "./error.js";

/** The plans that a module holds. Loops without a pause never collect; sets whose plans are gone plan again. */
const MOST = 1000;

export class Held {
    #free;
    /** @type {Map<number, WeakRef<HeldPlan>>} */
    #owners = new Map();
    #collected = new FinalizationRegistry((/** @type {number} */ plan) => this.#drop(plan));

    /** `free` frees a plan by its number. */
    constructor(/** @type {(plan: number) => void} */ free) {
        this.#free = free;
    }

    #drop(/** @type {number} */ plan) {
        this.#owners.delete(plan);
        this.#free(plan);
    }

    add(/** @type {HeldPlan} */ owner, /** @type {number} */ plan) {
        this.#collected.register(owner, plan, owner);
        this.#owners.set(plan, new WeakRef(owner));
        if (this.#owners.size <= MOST) return;
        const [[oldest, reference]] = this.#owners;
        reference.deref()?.free();
        this.#owners.delete(oldest);
    }

    /** Frees a plan at once. */
    remove(/** @type {HeldPlan} */ owner, /** @type {number} */ plan) {
        this.#collected.unregister(owner);
        this.#drop(plan);
    }
}

/** A plan by its number in a module. */
export class HeldPlan {
    #held;
    /** @type {number | undefined} */
    #plan;

    constructor(/** @type {Held} */ held, /** @type {number} */ plan) {
        this.#held = held;
        this.#plan = plan;
        held.add(this, plan);
    }

    get isFree() {
        return this.#plan === undefined;
    }

    /** Frees the memory. The plan has no points afterwards. */
    free() {
        if (this.#plan !== undefined) this.#held.remove(this, this.#plan);
        this.#plan = undefined;
    }

    /** Its number. */
    get place() {
        if (this.#plan === undefined) throw new StrewError("the plan is freed", "invalid-argument");
        return this.#plan;
    }
}
