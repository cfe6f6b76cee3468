// The API as a page: shows /openapi.json, an operation at a time. Everything is put in as text, never as markup.

import { Gone, askJson } from "../api.js";
import { byId, counted, make, skipLinks } from "../dom.js";
import { Notice } from "../notice.js";
import { watchTheme } from "../theme.js";
import { operationView } from "./operation.js";
import { resolved } from "./schema.js";

/** Whether a path is listed: the parts of pages are not. */
const isListed = (path) => path.split("/")[1] !== "page";

/** @type {any} */
let api = null;
let all = [];

/** An operation with its parameters in place of references to them. */
const complete = (operation, document) => (
  { ...operation, parameters: (operation.parameters ?? []).map((one) => resolved(one, document).of) }
);

/** The operations in the order of their tags. */
function operationsOf(document) {
  const found = Object.entries(document.paths).filter(([path]) => isListed(path)).flatMap(([path, item]) => (
    Object.entries(item).filter(([, one]) => one.operationId).map(([name, operation]) => ({
      path, operation: complete(operation, document), method: name.toUpperCase(), tag: operation.tags?.[0] ?? "other", id: operation.operationId,
    }))
  ));
  const tags = [...(document.tags ?? []).map(({ name }) => name), "other"];
  return found.sort((a, b) => tags.indexOf(a.tag) - tags.indexOf(b.tag));
}

/** The searchable text of an operation: its own words first, then those of its parameters. */
function wordsOf({ path, operation, method, tag, id }) {
  const parameters = operation.parameters.map((one) => `${one.name} ${one.description ?? ""}`);
  return [`${method} ${path} ${operation.summary} ${operation.description ?? ""} ${tag} ${id}`, ...parameters].map((text) => text.toLowerCase());
}

function list() {
  const about = new Map((api.tags ?? []).map(({ name, description }) => [name, description]));
  const groups = Map.groupBy(all, ({ tag }) => tag);
  byId("operations").replaceChildren(...[...groups].map(([tag, members]) => make("section", { "data-tag": tag },
    make("h2", { title: about.get(tag) }, tag),
    make("ul", {}, members.map((one) => make("li", { "data-id": one.id }, make("a", { href: `#${one.id}` },
      make("span", { class: `method ${one.method.toLowerCase()}` }, one.method), make("span", {}, one.operation.summary),
      make("code", {}, one.path), make("small", { class: "hit", hidden: true }))))))));
}

/** Shows the operations that have all words of the search, and the parameters that have them. */
function search() {
  const words = byId("search").value.toLowerCase().split(/\s+/).filter(Boolean);
  let hits = 0;
  for (const one of all) {
    const texts = wordsOf(one);
    const isHit = words.every((word) => texts.some((text) => text.includes(word)));
    const row = /** @type {HTMLElement} */ (document.querySelector(`[data-id="${one.id}"]`));
    row.hidden = !isHit;
    hits += isHit ? 1 : 0;
    const names = words.length === 0 ? [] : one.operation.parameters.filter((_, i) => words.some((word) => texts[i + 1].includes(word)));
    const hit = /** @type {HTMLElement} */ (row.querySelector(".hit"));
    hit.hidden = !isHit || names.length === 0;
    hit.textContent = names.slice(0, 4).map(({ name }) => name).join(", ") + (names.length > 4 ? " …" : "");
  }
  for (const section of document.querySelectorAll("[data-tag]")) section.hidden = !section.querySelector("li:not([hidden])");
  const isNone = words.length > 0 && hits === 0;
  byId("hits").textContent = isNone ? "No operation found" : words.length > 0 ? counted(hits, "operation") : "";
  // The overview invites to choose an operation: not where there is none to choose.
  if (!chosen()) byId("main").replaceChildren(...(isNone ? nothing() : overview()));
}

/** What the page says where a search finds nothing. */
function nothing() {
  const clear = () => {
    byId("search").value = "";
    search();
    byId("search").focus();
  };
  return [
    make("h2", { tabindex: "-1" }, "No operation found"),
    make("p", {}, `“${byId("search").value.trim()}” is in no operation's name, path or description, and in none of its parameters.`),
    make("p", {}, make("button", { type: "button", id: "clear", onclick: clear }, "Show all operations")),
  ];
}

function overview() {
  return [
    make("h2", { tabindex: "-1" }, "The API"),
    location.hash.length > 1 && make("p", { class: "bad" }, `This API has no operation “${named(location.hash.slice(1))}”.`),
    make("p", { class: "about" }, api.info.description),
    make("p", {}, "Choose an operation, or search: the search covers parameters, too. Each operation can be tried here and has its own link."),
    make("p", {}, "The same calls are served over gRPC on this port, with reflection: ", make("code", {}, "strew.v1.PointService"), ". This page shows ",
      make("a", { href: "/openapi.json" }, "/openapi.json"), ", from which clients can be generated."),
    make("ul", { class: "tags" }, (api.tags ?? []).map(({ name, description }) => {
      const members = all.filter(({ tag }) => tag === name);
      return members.length > 0 && make("li", {}, make("a", { href: `#${members[0].id}` },
        make("b", {}, name), make("span", {}, description), make("small", {}, counted(members.length, "operation"))));
    })),
  ].filter((one) => one !== false);
}

/** The text of an escaped address; the address itself if its escapes are wrong. */
function named(hash) {
  try {
    return decodeURIComponent(hash);
  } catch {
    return hash;
  }
}

/** The operation that the address names. */
function chosen() {
  const id = named(location.hash.slice(1));
  return all.find((operation) => operation.id === id);
}

/** Shows what the address names. */
function route(hasMoved) {
  const one = chosen();
  byId("main").replaceChildren(...(one ? operationView(one, api) : overview()));
  document.title = one ? `${one.operation.summary} · API · Strew` : "API · Strew";
  for (const link of /** @type {NodeListOf<HTMLAnchorElement>} */ (document.querySelectorAll("#operations a"))) {
    if (one && link.hash === `#${one.id}`) {
      link.setAttribute("aria-current", "page");
      link.scrollIntoView({ block: "nearest" });
    } else link.removeAttribute("aria-current");
  }
  if (!hasMoved) return;
  byId("side").classList.remove("open");
  byId("list").setAttribute("aria-expanded", "false");
  scrollTo(0, 0);
  byId("main").querySelector("h2")?.focus({ preventScroll: true });
}

async function begin() {
  try {
    api = await askJson("/openapi.json");
  } catch (error) {
    // The page begins again when the server is back.
    const words = error instanceof Gone ? "It is shown here as soon as the server answers." : `The server refused /openapi.json: ${/** @type {Error} */ (error).message}`;
    byId("main").replaceChildren(make("h2", {}, "The API"), make("p", { class: "bad" }, words));
    return;
  }
  all = operationsOf(api);
  byId("version").textContent = api.info.version;
  list();
  route(false);
  byId("search").addEventListener("input", search);
  byId("search").addEventListener("keydown", (event) => {
    if (event.key === "Enter") document.querySelector("#operations li:not([hidden]) a")?.click();
  });
  addEventListener("hashchange", () => route(true));
  document.documentElement.dataset.state = "ready";
}

new Notice(byId("banner"), () => api || begin());

watchTheme(byId("theme"), () => {});
byId("list").addEventListener("click", () => {
  const isOpen = byId("side").classList.toggle("open");
  byId("list").setAttribute("aria-expanded", String(isOpen));
});
addEventListener("keydown", (event) => {
  if (event.key !== "/" || /** @type {Element} */ (event.target).closest("input, textarea, select")) return;
  event.preventDefault();
  byId("side").classList.add("open");
  byId("search").focus();
});
skipLinks();
begin();
