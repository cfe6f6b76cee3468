// Schemas as trees that unfold: references are followed, members of members open where they are wanted. What is inside
// is made when it is opened, so a schema may contain itself.

import { make } from "../dom.js";

/** A schema or another part of the document behind its references, and the name of the last of them. */
export function resolved(part, api) {
  let [of, name] = [part ?? {}, null];
  for (let i = 0; of.$ref && i < 20; i += 1) {
    name = of.$ref.split("/").at(-1);
    of = of.$ref.slice(2).split("/").reduce((at, key) => at?.[key], api) ?? {};
  }
  return { of, name };
}

/** The forms that a schema has: itself, or those of which any will do. */
function forms(of) {
  return of.anyOf ?? of.oneOf ?? null;
}

/** The allowed values of a schema, in a few words. */
export function typeOf(schema, api, depth = 0) {
  const { of, name } = resolved(schema, api);
  if (of.const !== undefined) return JSON.stringify(of.const);
  if (of.enum) return of.enum.length > 8 ? "one of the values below" : of.enum.map((one) => JSON.stringify(one)).join(" | ");
  const any = of.properties ? null : forms(of);
  if (any) {
    const words = [...new Set(any.map((one) => typeOf(one, api, depth + 1)))];
    return words.length > 4 || depth > 1 ? (name ?? `one of ${any.length} forms`) : words.join(" | ");
  }
  if (of.type === "array") return of.prefixItems ? `array of ${of.prefixItems.length}` : `array of ${typeOf(of.items, api, depth + 1)}`;
  if (name && (of.type === "object" || of.properties || of.allOf)) return name;
  return [of.type ?? "any"].flat().join(" | ");
}

/** Whether a description has the limits in words. */
export const isSaid = (description) => Boolean(description?.includes("Allowed: "));

/** The limits of a value, in a few words each. */
export function limitsOf(schema, api) {
  const { of } = resolved(schema, api);
  const words = [];
  if (of.minimum !== undefined || of.maximum !== undefined) words.push(`${of.minimum ?? "−∞"} to ${of.maximum ?? "∞"}`);
  if (of.exclusiveMinimum !== undefined) words.push(`above ${of.exclusiveMinimum}`);
  if (of.exclusiveMaximum !== undefined) words.push(`below ${of.exclusiveMaximum}`);
  if (of.minItems !== undefined || of.maxItems !== undefined) words.push(`${of.minItems ?? 0} to ${of.maxItems ?? "∞"} items`);
  if (of.maxLength !== undefined) words.push(`${of.minLength ?? 0} to ${of.maxLength} characters`);
  if (of.default !== undefined) words.push(`default ${JSON.stringify(of.default)}`);
  if (of.enum?.length > 8) words.push(of.enum.map((one) => JSON.stringify(one)).join(" | "));
  return words;
}

/** Whether there is something below a schema to unfold. */
function hasMembers(schema, api, depth = 0) {
  const { of } = resolved(schema, api);
  if (of.properties || of.allOf || of.prefixItems) return true;
  if (depth > 4) return false;
  if (of.items && hasMembers(of.items, api, depth + 1)) return true;
  if (typeof of.additionalProperties === "object" && hasMembers(of.additionalProperties, api, depth + 1)) return true;
  return (forms(of) ?? []).some((one) => hasMembers(one, api, depth + 1));
}

/** A summary whose contents are made when it is opened. */
export function folded(summary, fill, isOpen = false) {
  const inside = make("div", { class: "inside" });
  const details = make("details", {}, make("summary", {}, summary), inside);
  const open = () => details.open && !inside.hasChildNodes() && inside.append(...[fill()].flat());
  details.addEventListener("toggle", open);
  if (isOpen) {
    details.open = true;
    open();
  }
  return details;
}

function member(name, schema, isRequired, api) {
  const { of } = resolved(schema, api);
  const head = [
    make("code", { class: "name" }, name), " ", make("span", { class: "type" }, typeOf(schema, api)),
    isRequired && make("span", { class: "required" }, " required"),
  ];
  const said = schema.description ?? of.description;
  const about = [said, ...(isSaid(said) ? [] : limitsOf(schema, api))].filter(Boolean).join(" · ");
  const words = about && make("p", {}, about);
  if (!hasMembers(schema, api)) return make("li", {}, make("div", {}, head), words);
  return make("li", {}, folded(make("span", {}, head), () => membersOf(schema, api)), words);
}

/** The members of a schema as a list, or its forms as lists. */
export function membersOf(schema, api) {
  const { of } = resolved(schema, api);
  const any = of.properties ? null : forms(of);
  if (any) {
    if (any.length === 1) return membersOf(any[0], api);
    return any.map((one) => {
      const title = [make("span", { class: "type" }, typeOf(one, api)), " ", resolved(one, api).of.description ?? ""];
      return hasMembers(one, api) ? folded(make("span", {}, title), () => membersOf(one, api)) : make("p", {}, title);
    });
  }
  if (of.allOf && !of.properties) return of.allOf.flatMap((one) => membersOf(one, api));
  if (of.prefixItems) return [make("ul", { class: "members" }, of.prefixItems.map((one, i) => member(`[${i}]`, one, true, api)))];
  if (of.items) return [make("p", { class: "note" }, "Each item:"), ...membersOf(of.items, api)];
  const rows = Object.entries(of.properties ?? {}).map(([name, one]) => member(name, one, of.required?.includes(name), api));
  if (typeof of.additionalProperties === "object") rows.push(member("any other name", of.additionalProperties, false, api));
  return rows.length > 0 ? [make("ul", { class: "members" }, rows)] : [make("p", {}, typeOf(schema, api))];
}
