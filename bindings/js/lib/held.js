// Plans in the memory of a module: freed once their sets are collected, and beyond a number of them the oldest first.

/** The plans that a module holds. Loops without a pause never collect; sets whose plans are gone plan again. */
const MOST = 1000;

export class Held {
    #free;
    #owners = new Map();
    #collected = new FinalizationRegistry((plan) => this.#drop(plan));

    /** `free` frees a plan by its number. */
    constructor(free) {
        this.#free = free;
    }

    #drop(plan) {
        this.#owners.delete(plan);
        this.#free(plan);
    }

    add(owner, plan) {
        this.#collected.register(owner, plan, owner);
        this.#owners.set(plan, new WeakRef(owner));
        if (this.#owners.size <= MOST) return;
        const [[oldest, reference]] = this.#owners;
        reference.deref()?.free();
        this.#owners.delete(oldest);
    }

    /** Frees a plan at once. */
    remove(owner, plan) {
        this.#collected.unregister(owner);
        this.#drop(plan);
    }
}
