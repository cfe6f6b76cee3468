// Where something begins in an order, by halving.

/** The first of the numbers below `count` for which something holds, and for all after it; `count` if for none. */
export function firstOf(/** @type {number} */ count, /** @type {(k: number) => boolean} */ holds) {
  let [low, high] = [0, count];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(middle)) high = middle;
    else low = middle + 1;
  }
  return low;
}
