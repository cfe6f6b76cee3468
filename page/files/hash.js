// Random numbers as a function of a seed and a place, so that any cell of the plane can be made alone.

/** 2⁻³²: from 32 bits to [0, 1). */
export const UNIT = 2 ** -32;

/** Mixes 32 bits: each bit of the result depends on all of those that come in ("lowbias32" by C. Wellons). */
export function mix(word) {
  let h = word ^ (word >>> 16);
  h = Math.imul(h, 0x7feb352d);
  h ^= h >>> 15;
  h = Math.imul(h, 0x846ca68b);
  return (h ^ (h >>> 16)) >>> 0;
}

/** An integer up to ±2⁵³ mixed into a state. */
export function stirred(state, integer) {
  const low = mix(state ^ (integer | 0));
  return mix(low + Math.floor(integer * UNIT));
}

/** A stream of numbers in [0, 1). */
export function streamOf(seed) {
  let state = mix(seed);
  let step = 0;
  return () => {
    step = (step + 0x9e3779b9) | 0;
    state = mix(state ^ step);
    return state * UNIT;
  };
}
