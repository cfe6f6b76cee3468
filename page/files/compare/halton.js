// The Halton sequence (J. H. Halton, 1960): point i is i written in base 2 and in base 3, each mirrored at the point.

/** i in a base, its digits mirrored at the point: 6 = 110₂ becomes 0.011₂ = 3/8. */
export function mirrored(i, base) {
  // In integers, so that only the division rounds.
  let [digits, all] = [0, 1];
  for (let rest = i; rest > 0; rest = Math.floor(rest / base)) {
    digits = digits * base + (rest % base);
    all *= base;
  }
  return digits / all;
}

/** The first `count` points, from index 0 on, over a box of `width` × `height`. */
export function halton(count, width, height) {
  const points = new Float64Array(2 * count);
  for (let i = 0; i < count; i += 1) {
    points[2 * i] = mirrored(i, 2) * width;
    points[2 * i + 1] = mirrored(i, 3) * height;
  }
  return points;
}
