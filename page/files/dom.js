// Elements by hand: everything is put in as text, never as markup.

/**
 * The element of an id; of its own kind where the markup of a page has it.
 * @template {string} Id
 * @param {Id} id
 * @returns {Id extends keyof Ids ? Ids[Id] : HTMLElement}
 */
export function byId(id) {
  return /** @type {any} */ (document.getElementById(id));
}

/**
 * An element with attributes, listeners (`onclick` and so on, as functions) and children; a child
 * that is text stays text, and what is `null` or `false` is left out.
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} name
 * @param {Record<string, any>} attributes
 * @param {...any} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** A drawing within SVG, made of paths: for icons. */
export function icon(/** @type {string} */ path, label = "") {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("class", "icon");
  if (label) svg.setAttribute("aria-label", label);
  else svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS(space, "path");
  line.setAttribute("d", path);
  svg.append(line);
  return svg;
}

/** Has links that skip parts of the page focus their targets: the address says what is shown, and stays. */
export function skipLinks() {
  for (const link of /** @type {NodeListOf<HTMLAnchorElement>} */ (document.querySelectorAll(".skip"))) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      byId(link.hash.slice(1)).focus();
    });
  }
}

/** Copies the text of an element; the button says how that went. */
export async function copy(/** @type {HTMLElement} */ element, /** @type {HTMLElement} */ button) {
  try {
    await navigator.clipboard.writeText(element.textContent);
    button.textContent = "Copied";
  } catch {
    // Without the permission the text is at least marked.
    getSelection()?.selectAllChildren(element);
    button.textContent = "Marked: copy it with Ctrl+C";
  }
}

/**
 * A function that calls another one once it was not called for some milliseconds; `cancel` forgets the call.
 * @template {any[]} Given
 * @param {number} wait
 * @param {(...given: Given) => void} call
 */
export function settled(wait, call) {
  let timer = 0;
  const later = (/** @type {Given} */ ...given) => {
    clearTimeout(timer);
    timer = setTimeout(() => call(...given), wait);
  };
  later.cancel = () => clearTimeout(timer);
  return later;
}

/** A function that calls another one in the next frame, once however often it is called until then. */
export function framed(/** @type {() => void} */ call) {
  let frame = 0;
  return () => (frame ||= requestAnimationFrame(() => {
    frame = 0;
    call();
  }));
}

/** A number with at most `digits` significant digits, groups of three set apart. */
export function spoken(/** @type {number} */ value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e15 || size < 1e-4)) return value.toExponential(Math.max(0, digits - 2)).replace(/\.?0*e\+?/, "e");
  return value.toLocaleString("en", { maximumSignificantDigits: Math.max(digits, size >= 1 ? Math.ceil(Math.log10(size + 1)) : 0) });
}

/** A count in full. */
export function counted(/** @type {number | bigint} */ count, one = "point", more = `${one}s`) {
  return `${count.toLocaleString("en")} ${count === 1 ? one : more}`;
}

/** A size in bytes, as people say it. */
export function bytes(/** @type {number} */ size) {
  for (const [unit, name] of /** @type {const} */ ([[1e9, "GB"], [1e6, "MB"], [1e3, "kB"]])) {
    if (size >= unit) return `${(size / unit).toPrecision(3)} ${name}`;
  }
  return `${size} bytes`;
}

/** The context that draws on a canvas: every browser that runs modules has one. */
export function contextOf(/** @type {HTMLCanvasElement} */ canvas, /** @type {CanvasRenderingContext2DSettings} */ options = {}) {
  return /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", options));
}
