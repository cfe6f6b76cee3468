// Coordinates that stay exact far out: an integer and a fraction in [0, 1), added up. At 1e12 a
// single double tells places apart by 1e-4 only; the fraction here keeps all of its digits.

/**
 * A coordinate: `i` is an integer, `f` is in [0, 1).
 * @typedef {{ i: number, f: number }} Place
 */

/** A coordinate from two numbers. */
export function place(/** @type {number} */ i, f = 0) {
  const whole = Math.floor(i);
  const sum = f + (i - whole);
  const carry = Math.floor(sum);
  return { i: whole + carry, f: sum - carry };
}

/** A coordinate moved by a distance. */
export function moved(/** @type {Place} */ at, /** @type {number} */ by) {
  const sum = at.f + by;
  const carry = Math.floor(sum);
  return { i: at.i + carry, f: sum - carry };
}

/** How far `a` is from `b`: exact if they are near each other. */
export function distance(/** @type {Place} */ a, /** @type {Place} */ b) {
  return (a.i - b.i) + (a.f - b.f);
}

/** The nearest double. */
export function toNumber(/** @type {Place} */ at) {
  return at.i + at.f;
}

const DECIMAL = /^([+-]?)(\d*)(?:\.(\d*))?(?:e([+-]?\d{1,3}))?$/i;

/** Reads a decimal number, such as `-12.5` or `1e12`; `null` if it is none. */
export function parsePlace(/** @type {string} */ text) {
  const parts = DECIMAL.exec(text.trim().replace(/[\s_']/g, "").replace("−", "-"));
  if (!parts || !(parts[2] || parts[3])) return null;
  const [, sign, before = "", after = "", exponent = "0"] = parts;
  const digits = before + after;
  const point = before.length + Number(exponent);
  const whole = point <= 0 ? "0" : digits.slice(0, point).padEnd(point, "0");
  const rest = point <= 0 ? "0".repeat(-point) + digits : digits.slice(point);
  const i = Number(whole || "0");
  const f = Number(`0.${rest || "0"}`);
  if (!Number.isFinite(i) || i > 1e300) return null;
  return sign === "-" ? place(-i, -f) : place(i, f);
}

/** Writes a coordinate with at most `decimals` decimals, without a loss before the point. */
export function formatPlace(/** @type {Place} */ at, decimals = 12) {
  if (Math.abs(at.i) > Number.MAX_SAFE_INTEGER) return String(toNumber(at));
  const isNegative = at.i < 0;
  let whole = isNegative ? -at.i : at.i;
  let rest = at.f;
  if (isNegative && at.f > 0) {
    whole -= 1;
    rest = 1 - at.f;
  }
  let text = rest.toFixed(Math.max(0, Math.min(100, decimals)));
  if (text.startsWith("1")) {
    whole += 1;
    text = text.replace("1", "0");
  }
  const tail = text.includes(".") ? text.slice(1).replace(/\.?0+$/, "") : "";
  const isZero = whole === 0 && tail === "";
  return `${isNegative && !isZero ? "-" : ""}${BigInt(whole)}${tail}`;
}

/** Decimals that tell steps of a size apart. */
export function decimalsFor(/** @type {number} */ step) {
  return Math.max(0, Math.min(100, Math.ceil(-Math.log10(step))));
}
