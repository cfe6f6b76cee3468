// The tab Take away: the view's request to paste, and its points as a file.

import { hasKey, isAborted, wordsOf } from "./api.js";
import { FORMATS, curl, grpcurl, python, requestOf } from "./commands.js";
import { byId, bytes, copy, counted, make, settled } from "./dom.js";
import { MOST_HELD, save, sizeOf } from "./download.js";
import { worldOf } from "./paint/world.js";
import { Part } from "./part.js";
import { boxOf } from "./query.js";
import { countIn } from "./status.js";

const WAYS = { curl: "curl", grpcurl: "grpcurl", python: "Python", url: "URL", world: "World" };

export class Take extends Part {
  constructor(session, plane) {
    super();
    this.session = session;
    this.plane = plane;
    /** @type {keyof typeof WAYS} */
    this.way = "curl";
    this.format = "csv";
    this.isThinned = true;
    /** @type {{ bytes: number, isExact: boolean } | null} */
    this.weight = null;
    this.again = settled(250, () => this.weigh());
    this.what = make("p", { class: "note" });
    this.thin = make("input", { type: "checkbox", id: "take-thinned", checked: true, onchange: (event) => {
      this.isThinned = event.target.checked;
      this.render();
      this.again();
    } });
    this.thinLine = make("label", { class: "check" }, this.thin, "Only the points that are drawn");
    this.formats = make("select", { id: "format", onchange: (event) => {
      this.format = event.target.value;
      this.render();
      this.again();
    } }, FORMATS.map(([name, , use]) => make("option", { value: name }, `${name} — ${use}`)));
    this.ways = make("div", { class: "choices", role: "group", "aria-label": "How to ask" }, Object.entries(WAYS).map(([id, words]) => make("button", {
      type: "button", id: `way-${id}`, onclick: () => {
        this.way = /** @type {keyof typeof WAYS} */ (id);
        this.render();
      },
    }, words)));
    this.text = make("code", { id: "command" });
    this.copyButton = make("button", { type: "button", id: "copy", class: "main", onclick: () => copy(this.text, this.copyButton) }, "Copy");
    this.amount = make("p", { class: "big", id: "take-count", role: "status" });
    this.size = make("p", { class: "note", id: "take-size", role: "status" });
    this.button = make("button", { type: "button", id: "download", class: "main", onclick: () => this.download() }, "Download");
    this.bar = make("progress", { hidden: true, "aria-label": "Download" });
    byId("take").append(
      make("div", { class: "field" }, this.amount, this.size, this.thinLine),
      make("div", { class: "field" }, make("label", { for: "format" }, "Format"), this.formats),
      this.button, this.bar,
      make("div", { class: "group" }, make("span", { class: "label" }, "Or request exactly these points yourself"),
        this.ways, make("pre", { tabindex: "0", "aria-label": "The request" }, this.text), this.copyButton, this.what),
    );
  }

  get isOpen() {
    return this.session.state.tab === "take";
  }

  get keep() {
    return this.isThinned ? this.plane.keep : 1;
  }

  get request() {
    return requestOf(this.session.state.layers, boxOf(this.plane.view), this.keep, this.format);
  }

  get file() {
    return `points.${FORMATS.find(([name]) => name === this.format)?.[1]}`;
  }

  opened() {
    this.rested();
  }

  moved() {
    document.documentElement.dataset.weighed = "";
    this.button.disabled = true;
  }

  shown() {
    this.moved();
  }

  rested() {
    if (!this.isOpen || !this.plane.look) return;
    this.render();
    this.again();
  }

  render() {
    const { layers } = this.session.state;
    this.thinLine.hidden = this.plane.keep >= 1;
    const { request } = this;
    const texts = {
      curl: () => curl(location.origin, request, this.file),
      grpcurl: () => grpcurl(location.host, layers, boxOf(this.plane.view), this.keep),
      python: () => python(location.origin, request, this.format, this.file),
      url: () => (request.body ? `POST ${location.origin}${request.path}\n\n${request.body}` : location.origin + request.path),
      world: () => (layers[0].world ? `${location.origin}/v1/worlds/${layers[0].world.name}` : worldOf(layers)),
    };
    this.text.textContent = texts[this.way]();
    for (const id of Object.keys(WAYS)) byId(`way-${id}`).setAttribute("aria-pressed", String(id === this.way));
    this.what.textContent = {
      curl: "For a shell.",
      grpcurl: "For a shell; gRPC streams messages, whatever the format above.",
      python: this.format === "npy" ? "For Python 3 with numpy." : "For Python 3, with nothing installed.",
      url: request.body ? "Several layers, and fields that were sent, need a body, which an address cannot hold." : "For a browser, or anything else that reads addresses.",
      world: layers[0].world ? "The description of this world." : "A file for the daemon's folder of worlds (worlds.folder), such as forest.json; then chunks are at /v1/worlds/forest/chunks/…",
    }[this.way];
    if (hasKey()) this.what.textContent += " Add your key, as the header “Authorization: Bearer …”.";
    this.copyButton.textContent = "Copy";
  }

  /** Says how many points and bytes the view is. */
  async weigh() {
    if (!this.isOpen || !this.plane.look) return;
    this.abort?.abort();
    this.abort = new AbortController();
    const { signal } = this.abort;
    const { request, format } = this;
    this.size.classList.remove("bad");
    try {
      this.count = await countIn(this.session.state.layers, boxOf(this.plane.view), this.keep, signal);
      this.amount.textContent = counted(this.count);
      this.size.textContent = "weighing …";
      this.weight = await sizeOf(request, format, this.count, signal);
      const { bytes: size, isExact } = this.weight;
      const words = Number.isFinite(size) ? `${isExact ? "" : "about "}${bytes(size)}` : "size not known in advance";
      this.size.textContent = `${words} as ${format}`;
      const isHeld = request.body && size > MOST_HELD;
      if (isHeld) this.size.textContent += ": too much for this page to hold, use the command below";
      this.button.disabled = Boolean(isHeld);
      document.documentElement.dataset.weighed = String(this.count);
    } catch (error) {
      if (isAborted(error)) return;
      this.size.textContent = wordsOf(error);
      this.size.classList.add("bad");
      this.button.disabled = true;
    }
  }

  async download() {
    const { request, file, weight } = this;
    this.bar.hidden = !request.body;
    if (weight && Number.isFinite(weight.bytes)) this.bar.max = weight.bytes;
    this.button.disabled = true;
    try {
      await save(request, file, (come) => (this.bar.value = come));
      this.size.textContent = `${file} is in your downloads`;
    } catch (error) {
      this.size.textContent = wordsOf(error);
      this.size.classList.add("bad");
    }
    this.bar.hidden = true;
    this.button.disabled = false;
  }
}
