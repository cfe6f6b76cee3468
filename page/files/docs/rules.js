// The rules between the parameters of an operation, as a table with a row for each parameter that has some.

import { make } from "../dom.js";

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
export function rulesTable(rules = []) {
  const rows = new Map();
  for (const [name, words] of rules.flatMap(saidBy)) rows.set(name, [...(rows.get(name) ?? []), words]);
  if (rows.size === 0) return null;
  return make("table", { class: "rules" },
    make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "Parameter"), make("th", { scope: "col" }, "Allowed"))),
    make("tbody", {}, [...rows].map(([name, all]) => make("tr", {}, make("th", { scope: "row" }, code(name)),
      make("td", {}, all.map((words) => make("div", {}, ...words)))))));
}
