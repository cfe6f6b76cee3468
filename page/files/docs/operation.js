// One operation: what it is for, its parameters, body and answers, and a form to try it.

import { make } from "../dom.js";
import { attempt } from "./attempt.js";
import { folded, isSaid, limitsOf, membersOf, resolved, typeOf } from "./schema.js";

/** A description; its list of rules is in the table below. */
function prose(text, hasRules) {
  const [about, ...items] = text.split(/\n+- /);
  return [
    make("p", { class: "about" }, about),
    items.length > 0 && !hasRules && make("ul", { class: "about" }, items.map((item) => make("li", {}, item))),
  ].filter((one) => one !== false);
}

const code = (name) => make("code", {}, name);

/** Names in a row, with a word before the last. */
function listed(names, word) {
  return names.flatMap((name, i) => [i === 0 ? "" : i === names.length - 1 ? ` ${word} ` : ", ", name].filter(Boolean));
}

/** A parameter with the values that it needs to have: “attributes (scale or rank)”. */
function having(name, values) {
  return make("span", {}, code(name), values.length > 0 && [" (", ...listed(values.map(code), "or"), ")"]);
}

/** What a rule says of each of its parameters, as `[name, words]`. */
function saidBy(rule) {
  const others = (name) => listed(rule.parameters.filter((one) => one !== name).map(code), "or");
  switch (rule.rule) {
    case "exactly-one-of":
      return rule.parameters.map((name) => [name, ["exactly one: this, ", ...others(name), ...(rule.unless ? ["; none is needed with ", code(rule.unless)] : [])]]);
    case "at-most-one-of":
      return rule.parameters.map((name) => [name, ["not with ", ...others(name)]]);
    case "only-with":
      return [[rule.parameter, ["only with ", having(rule.other, rule.values)]]];
    case "only-with-one-of":
      return [[rule.parameter, ["only with ", ...listed(rule.others.map(({ parameter, values }) => having(parameter, values)), "or")]]];
    case "not-with":
      return [[rule.parameter, ["not with ", ...listed(rule.others.map(code), "or")]],
        ...rule.others.map((name) => [name, ["not with ", code(rule.parameter)]])];
    case "needs":
      return [[rule.parameter, [code(rule.value), " needs ", code(rule.needs)]]];
    default:
      return [];
  }
}

/** The table of rules, `null` if there are none. */
function rulesTable(rules = []) {
  const rows = new Map();
  for (const [name, words] of rules.flatMap(saidBy)) rows.set(name, [...(rows.get(name) ?? []), words]);
  if (rows.size === 0) return null;
  return make("table", { class: "rules" },
    make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "Parameter"), make("th", { scope: "col" }, "Allowed"))),
    make("tbody", {}, [...rows].map(([name, all]) => make("tr", {}, make("th", { scope: "row" }, code(name)),
      make("td", {}, all.map((words) => make("div", {}, ...words)))))));
}

function rules(operation) {
  const table = rulesTable(operation["x-rules"]);
  return table ? [folded("Which parameters go together", () => table, operation["x-rules"].length <= 3)] : [];
}

function parameterRow(one, api) {
  const { of } = resolved(one.schema, api);
  const limits = isSaid(one.description) ? [] : limitsOf(one.schema, api);
  return make("li", { id: `parameter-${one.name}` },
    make("div", {}, make("code", { class: "name" }, one.name), " ",
      make("span", { class: "type" }, `${one.in}, ${typeOf(one.schema, api)}`),
      one.required && make("span", { class: "required" }, " required")),
    make("p", {}, one.description ?? of.description ?? ""),
    limits.length > 0 && make("p", { class: "note" }, limits.join(" · ")),
    one.example !== undefined && make("p", { class: "note" }, "Example: ", make("code", {}, String(one.example))));
}

function parameters(list, api) {
  if (list.length === 0) return [];
  const rows = [...list].sort((a, b) => Number(b.required) - Number(a.required)).map((one) => parameterRow(one, api));
  const few = rows.slice(0, 8);
  const rest = rows.slice(8);
  return [
    make("h3", {}, `Parameters (${rows.length})`),
    make("ul", { class: "members" }, few),
    rest.length > 0 && folded(`${rest.length} more`, () => make("ul", { class: "members" }, rest)),
  ];
}

function body(request, api) {
  return Object.entries(request?.content ?? {}).flatMap(([type, content]) => [
    make("h3", {}, `Body, ${type}`),
    request.description && make("p", {}, request.description),
    make("p", {}, make("span", { class: "type" }, typeOf(content.schema, api)), " ", resolved(content.schema, api).of.description ?? ""),
    ...membersOf(content.schema, api),
  ]);
}

function contentOf(type, content, api) {
  const example = content.example ?? Object.values(content.examples ?? {})[0]?.value;
  return folded(make("span", {}, make("code", {}, type), " ", make("span", { class: "type" }, typeOf(content.schema, api))), () => [
    ...membersOf(content.schema, api),
    example !== undefined && make("pre", { role: "group", tabindex: "0", "aria-label": "An example" }, typeof example === "string" ? example : JSON.stringify(example, null, 2)),
  ].filter(Boolean));
}

function answers(responses, api) {
  return Object.entries(responses).map(([status, given]) => {
    const { of } = resolved(given, api);
    const headers = Object.entries(of.headers ?? {});
    const title = make("span", {}, make("b", { class: Number(status) < 400 ? "good" : "bad" }, status), " ", of.description);
    return folded(title, () => [
      headers.length > 0 && folded(`${headers.length} headers`, () => make("ul", { class: "members" }, headers.map(([name, header]) => (
        make("li", {}, make("code", { class: "name" }, name), make("p", {}, resolved(header, api).of.description ?? ""))
      )))),
      ...Object.entries(of.content ?? {}).map(([type, content]) => contentOf(type, content, api)),
      !of.content && headers.length === 0 && make("p", { class: "note" }, "No body."),
    ].filter(Boolean), status.startsWith("2"));
  });
}

/** Everything about an operation. */
export function operationView({ path, method, operation, tag }, api) {
  return [
    make("p", { class: "crumb" }, tag),
    make("h2", { tabindex: "-1" }, operation.summary),
    make("p", { class: "path" }, make("span", { class: `method ${method.toLowerCase()}` }, method), make("code", {}, path)),
    ...prose(operation.description ?? "", operation["x-rules"]?.length > 0),
    make("div", { class: "columns" },
      make("div", {},
        ...parameters(operation.parameters, api).filter(Boolean),
        ...rules(operation),
        ...body(operation.requestBody, api),
        make("h3", {}, "Responses"), ...answers(operation.responses, api)),
      make("div", { class: "trying" }, make("h3", {}, "Try it here"), ...attempt(path, method, operation, api))),
  ];
}
