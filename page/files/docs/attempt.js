// Trying an operation: a form with its parameters, the curl line of what the form says, and what the server answers.

import { brokeOff, digits, hasKey, headersFor, piecesOf } from "../api.js";
import { encoded } from "../address.js";
import { quoted } from "../commands.js";
import { bytes, contextOf, copy, make } from "../dom.js";
import { keyForm } from "../form.js";
import { resolved } from "./schema.js";

/** The most bytes of an answer that are shown. */
const SHOWN = 20_000;

/** The address of an operation's example, and whether it has a body: from the line for curl. */
function exampleOf(operation) {
  const line = operation["x-curl"] ?? "";
  const address = line.startsWith("'") ? line.slice(1).split("'")[0] : line.split(" ")[0];
  return new URL(address || "/", location.origin);
}

/** The values that the example has for parameters, by where these are and their names. */
function givenBy(path, operation) {
  const address = exampleOf(operation);
  const given = new Map([...address.searchParams].map(([name, value]) => [`query ${name}`, value]));
  const names = [];
  const escaped = (text) => text.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  const pattern = path.split(/\{(\w+)\}/).map((piece, i) => (i % 2 ? (names.push(piece), "([^/]+)") : escaped(piece))).join("");
  const found = new RegExp(`^${pattern}$`).exec(decodeURI(address.pathname));
  names.forEach((name, i) => found && given.set(`path ${name}`, found[i + 1]));
  return given;
}

function control(parameter, value, api) {
  const { of } = resolved(parameter.schema, api);
  const id = `try-${parameter.in}-${parameter.name}`;
  const example = parameter.example ?? of.examples?.[0] ?? of.default ?? "";
  const options = of.enum ?? (of.type === "boolean" ? [true, false] : null);
  const field = options
    ? make("select", { id }, make("option", { value: "" }, "–"), options.map((one) => make("option", { value: String(one) }, String(one))))
    : make("input", { id, placeholder: String(example), spellcheck: "false", autocomplete: "off", required: parameter.required });
  field.value = value ?? (parameter.required ? String(example) : "");
  return { parameter, field, row: make("div", { class: "field" }, make("label", { for: id }, parameter.name, parameter.required && make("span", { class: "required" }, " required")), field) };
}

/** JSON without the spaces between its parts; digits stay as they are. */
const compact = (text) => text.replace(/("(?:[^"\\]|\\.)*")|\s+/g, "$1");

/** The form, the line for curl, and the answer. */
export function attempt(path, method, operation, api) {
  const given = givenBy(path, operation);
  const fields = operation.parameters.map((one) => control(one, given.get(`${one.in} ${one.name}`), api));
  const content = Object.entries(operation.requestBody?.content ?? {})[0];
  const body = content && make("textarea", { id: "try-body", rows: "12", spellcheck: "false" });
  if (body) body.value = content[1].example === undefined ? "" : JSON.stringify(content[1].example, null, 2);

  const request = () => {
    let address = path;
    const query = [];
    for (const { parameter, field } of fields) {
      if (parameter.in === "path") address = address.replace(`{${parameter.name}}`, encoded(field.value).replaceAll("/", "%2F"));
      else if (parameter.in === "query" && field.value !== "") query.push(`${parameter.name}=${encoded(field.value)}`);
    }
    const headers = fields.filter(({ parameter, field }) => parameter.in === "header" && field.value !== "")
      .map(({ parameter, field }) => [parameter.name, field.value]);
    return { address: address + (query.length ? `?${query.join("&")}` : ""), headers, text: body?.value || undefined };
  };
  const curl = () => {
    const { address, headers, text } = request();
    const plain = method === "GET" || (method === "POST" && text !== undefined) ? "" : `-X ${method} `;
    const more = headers.map(([name, value]) => ` -H ${quoted(`${name}: ${value}`)}`);
    if (hasKey()) more.push(' -H "authorization: Bearer $STREW_API_KEY"');
    if (text !== undefined) more.push(` -H ${quoted(`content-type: ${content[0]}`)} -d ${quoted(content[0].includes("json") ? compact(text) : text)}`);
    return `curl ${plain}${quoted(location.origin + address)}${more.join("")}`;
  };

  const line = make("code", {}, curl());
  const copyButton = make("button", { type: "button", "aria-label": "Copy the command", onclick: () => copy(line, copyButton) }, "Copy");
  const answer = make("div", { id: "answer", "aria-live": "polite" });
  const send = make("button", { type: "submit", class: "main" }, "Send");
  const update = () => (line.textContent = curl());
  /** @type {HTMLElement[][]} */
  const [shown, others] = [[], []];
  for (const one of fields) (one.field.value !== "" || one.parameter.required ? shown : others).push(one.row);
  const form = make("form", { class: "try" },
    make("div", { class: "fields" }, shown),
    others.length > 0 && make("details", {}, make("summary", {}, `${others.length} more parameters`), make("div", { class: "fields" }, others)),
    body && make("div", { class: "field wide" }, make("label", { for: "try-body" }, `Body, ${content[0]}`), body),
    make("div", { class: "line" }, make("pre", { role: "group", tabindex: "0", "aria-label": "The line for curl" }, line), copyButton),
    send);
  form.addEventListener("input", update, true);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    send.disabled = true;
    try {
      answer.replaceChildren(...await sent(request(), method, content?.[0], update));
    } finally {
      send.disabled = false;
    }
  });
  return [form, answer];
}

async function sent({ address, headers, text }, method, type, update) {
  const began = performance.now();
  try {
    const all = { ...headersFor(text), ...Object.fromEntries(headers) };
    if (text !== undefined) all["content-type"] = type;
    const answer = await fetch(address, { method, headers: all, body: text });
    const { parts, received, isWhole } = await beginning(answer);
    const took = Math.round(performance.now() - began);
    const kind = answer.headers.get("content-type") ?? "";
    const blob = new Blob(parts, { type: kind });
    const rows = [...answer.headers].flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]);
    return [
      make("p", { class: answer.ok ? "status" : "status bad" }, make("b", { id: "status" }, `${answer.status} ${answer.statusText}`.trim()),
        ` · ${took} ms · ${isWhole ? "" : "more than "}${bytes(received)}`),
      answer.status === 401 && keyForm(update),
      make("details", {}, make("summary", {}, `${rows.length / 2} headers`), make("dl", { class: "headers" }, rows)),
      await seen(blob, kind, isWhole),
    ].filter((one) => one !== false);
  } catch {
    brokeOff();
    return [make("p", { class: "status bad" }, "No answer came. Send it again when the server is back.")];
  }
}

/** The first part of a body; the rest is not waited for. */
async function beginning(answer) {
  const parts = [];
  let received = 0;
  for await (const piece of answer.body ? piecesOf(answer) : []) {
    parts.push(piece);
    received += piece.length;
    if (received > 50 * SHOWN) return { parts, received, isWhole: false };
  }
  return { parts, received, isWhole: true };
}

async function seen(blob, kind, isWhole) {
  if (blob.size === 0) return make("p", { class: "note" }, "No body.");
  if (kind.startsWith("image/") && isWhole) return picture(blob);
  if (!/json|text|csv|xml|toml/.test(kind)) return make("p", { class: "note" }, `Binary, ${kind || "without a type"}.`);
  let text = await blob.slice(0, SHOWN).text();
  if (kind.includes("json") && isWhole && blob.size <= SHOWN) text = pretty(text);
  return make("pre", { id: "body", role: "group", tabindex: "0", "aria-label": "The body" }, text, blob.size > SHOWN && "\n…");
}

/** The picture of an answer, drawn from its bytes: another request would lack the body and the key. */
async function picture(blob) {
  try {
    const bitmap = await createImageBitmap(blob);
    const canvas = make("canvas", { role: "img", "aria-label": "The picture of the answer" });
    Object.assign(canvas, { width: bitmap.width, height: bitmap.height });
    contextOf(canvas).drawImage(bitmap, 0, 0);
    return canvas;
  } catch {
    return make("pre", { id: "body", role: "group", tabindex: "0", "aria-label": "The body" }, await blob.slice(0, SHOWN).text());
  }
}

/** JSON with a member a line, its numbers as they came; what is no single document stays as it is. */
function pretty(text) {
  try {
    return JSON.stringify(JSON.parse(text, (_, value, from) => (typeof value === "number" && from?.source ? digits(from.source) : value)), null, 2);
  } catch {
    return text;
  }
}
