// Shows /openapi.json. Everything is put in as text, never as markup.

/** An element with attributes and children; a text child stays text. */
function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** Follows a reference within the document. */
function resolved(schema, api) {
  if (!schema?.$ref) return schema;
  const found = schema.$ref.slice(2).split("/").reduce((at, key) => at?.[key], api);
  return found ?? {};
}

/** What a schema allows, in a few words. */
function shape(schema, api) {
  const of = resolved(schema, api) ?? {};
  if (of.anyOf) return of.anyOf.map((one) => shape(one, api)).join(", or ");
  if (of.enum) return of.enum.join(" | ");
  const bounds = "minimum" in of && "maximum" in of ? ` ${of.minimum} to ${of.maximum}` : "";
  return `${[of.type].flat().join(" or ")}${bounds}`;
}

function parameters(list, api) {
  const terms = list.flatMap((one) => [
    make("dt", {},
      make("b", {}, make("code", {}, one.name)), " ",
      make("small", {}, `${one.in}, ${shape(one.schema, api)}`),
      one.required ? make("small", { class: "required" }, " required") : null),
    make("dd", {}, one.description ?? ""),
  ]);
  return terms.length ? [make("h3", {}, "Parameters"), make("dl", {}, ...terms)] : [];
}

function answers(responses) {
  const terms = Object.entries(responses).flatMap(([status, answer]) => [
    make("dt", {}, make("b", {}, status), " ",
      make("small", {}, Object.keys(answer.content ?? {}).join(", "))),
    make("dd", {}, answer.description,
      ...Object.entries(answer.headers ?? {}).map(([name, header]) =>
        make("p", {}, make("code", {}, name), `: ${header.description}`))),
  ]);
  return [make("h3", {}, "Answers"), make("dl", {}, ...terms)];
}

function curl(operation) {
  const example = operation["x-curl"];
  const quoted = example.startsWith("'");
  const line = `curl ${quoted ? `'${location.origin}${example.slice(1)}` : location.origin + example}`;
  const button = make("button", { type: "button", "aria-label": "Copy the command" }, "Copy");
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(line);
      button.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(button.previousSibling);
      button.textContent = "Selected";
    }
  });
  return make("div", { class: "curl" }, make("pre", {}, make("code", {}, line)), button);
}

function body(request) {
  return Object.entries(request?.content ?? {}).flatMap(([type, content]) => [
    make("h3", {}, `Body, ${type}`),
    make("pre", {}, JSON.stringify(content.example, null, 2)),
    make("details", {}, make("summary", {}, "Schema"),
      make("pre", {}, JSON.stringify(content.schema, null, 2))),
  ]);
}

function section(path, method, operation, api) {
  return make("section", { id: operation.operationId },
    make("h2", {}, make("span", { class: "method" }, method), make("code", {}, path)),
    make("p", {}, make("b", {}, operation.summary), ". ", operation.description ?? ""),
    curl(operation),
    ...parameters(operation.parameters ?? [], api),
    ...body(operation.requestBody),
    make("details", {}, make("summary", {}, "Answers"), ...answers(operation.responses).slice(1)));
}

function show(api) {
  document.getElementById("version").textContent = api.info.version;
  document.getElementById("about").textContent = api.info.description;
  // What is asked for most comes first; the parts of this page need no telling.
  const rank = ([path]) => (path.startsWith("/v1/") ? 0 : 1);
  const paths = Object.entries(api.paths).filter(([path]) => !path.startsWith("/docs/") && !path.startsWith("/page/"));
  for (const [path, item] of paths.sort((a, b) => rank(a) - rank(b))) {
    for (const [name, operation] of Object.entries(item)) {
      const method = name.toUpperCase();
      document.getElementById("contents").append(make("a", { href: `#${operation.operationId}` },
        make("span", { class: "method" }, method), make("code", {}, path), " ",
        make("small", {}, operation.summary)));
      document.getElementById("operations").append(section(path, method, operation, api));
    }
  }
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

try {
  const answer = await fetch("/openapi.json");
  if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
  show(await answer.json());
} catch (error) {
  document.getElementById("about").textContent = `/openapi.json cannot be shown: ${error.message}`;
}
