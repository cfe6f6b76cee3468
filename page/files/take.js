// The tab Take: the points in view, or what repeats, as a file and as a request to paste.

import { hasKey, isAborted, wordsOf } from "./api.js";
import { FORMATS, curl, looksOf, python, requestOf } from "./commands.js";
import { byId, bytes, copy, counted, make, settled } from "./dom.js";
import { MOST_HELD, save, sizeOf } from "./download.js";
import { select, setOptions } from "./form.js";
import { boxOf, joined } from "./query.js";
import { Repeat } from "./repeat.js";
import { countIn } from "./status.js";

/** What can be taken away, as the address has it. */
const WHAT = [["", "The points in view"], ["tile", "A tile that repeats without a seam"], ["mask", "A mask for dithering, which repeats"]];
const WAYS = { curl: "curl", python: "Python", url: "URL" };

export class Take {
  constructor(session, plane) {
    this.session = session;
    this.plane = plane;
    /** @type {keyof typeof WAYS} */
    this.way = "curl";
    this.format = "csv";
    this.isThinned = true;
    /** @type {{ bytes: number, isExact: boolean } | null} */
    this.weight = null;
    this.again = settled(250, () => this.weigh());
    this.what = select("take-what", (take) => session.choose((state) => Object.assign(state, { take }), "tab"));
    this.repeat = new Repeat(() => this.again());
    this.help = make("p", { class: "note" });
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
    this.formatLine = make("div", { class: "field" }, make("label", { for: "format" }, "Format"), this.formats);
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
      make("div", { class: "field" }, make("label", { for: "take-what" }, "What"), this.what),
      this.repeat.element,
      make("div", { class: "field" }, this.amount, this.size, this.thinLine),
      this.formatLine,
      this.button, this.bar,
      make("div", { class: "group" }, make("span", { class: "label" }, "Or request exactly these points yourself"),
        this.ways, make("pre", { tabindex: "0", "aria-label": "The request" }, this.text), this.copyButton, this.help),
    );
  }

  get isOpen() {
    return this.session.state.tab === "take";
  }

  get keep() {
    return this.isThinned ? this.plane.keep : 1;
  }

  /** What is taken away in place of the view: `tile` or `mask`. A world has layers of its own. */
  get repeats() {
    const { take, world } = this.session.state;
    return world ? "" : take;
  }

  /** The format of the file. */
  get form() {
    return this.repeats === "mask" ? "png" : this.format;
  }

  get request() {
    const { repeats, form } = this;
    const [layer] = this.session.state.layers;
    if (repeats === "mask") return { path: this.repeat.path(repeats, layer) };
    if (repeats) return { path: `${this.repeat.path(repeats, layer)}&${joined([["format", form], ...looksOf(form)])}` };
    return requestOf(this.session.state.layers, boxOf(this.plane.view), this.keep, form);
  }

  get file() {
    const ending = FORMATS.find(([name]) => name === this.form)?.[1];
    return `${this.repeats || "points"}.${ending}`;
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
    const { repeats } = this;
    setOptions(this.what, layers[0].world ? WHAT.slice(0, 1) : WHAT, repeats);
    this.repeat.element.hidden = !repeats;
    this.thinLine.hidden = Boolean(repeats) || this.plane.keep >= 1;
    this.formatLine.hidden = repeats === "mask";
    const { request } = this;
    const texts = {
      curl: () => curl(location.origin, request, this.file),
      python: () => python(location.origin, request, this.form, this.file),
      url: () => (request.body ? `POST ${location.origin}${request.path}\n\n${request.body}` : location.origin + request.path),
    };
    this.text.textContent = texts[this.way]();
    for (const id of Object.keys(WAYS)) byId(`way-${id}`).setAttribute("aria-pressed", String(id === this.way));
    this.help.textContent = {
      curl: "For a shell.",
      python: this.form === "npy" ? "For Python 3 with numpy." : "For Python 3, with nothing installed.",
      url: request.body ? "Several layers, and fields that were sent, need a body, which an address cannot hold." : "For a browser, or anything else that reads addresses.",
    }[this.way];
    if (hasKey()) this.help.textContent += " Add your key, as the header “Authorization: Bearer …”.";
    this.copyButton.textContent = "Copy";
  }

  /** Says how many points and bytes the view is. */
  async weigh() {
    if (!this.isOpen || !this.plane.look) return;
    this.abort?.abort();
    this.abort = new AbortController();
    const { signal } = this.abort;
    const { repeats, form } = this;
    this.size.classList.remove("bad");
    try {
      const { layers } = this.session.state;
      this.count = repeats
        ? await this.repeat.show(repeats, layers[0], signal)
        : await countIn(layers, boxOf(this.plane.view), this.keep, signal);
      // The sizes that repeat are known now.
      this.render();
      const { request } = this;
      this.amount.textContent = repeats === "mask" ? "" : counted(this.count);
      this.size.textContent = "weighing …";
      this.weight = await sizeOf(request, form, this.count, signal);
      const { bytes: size, isExact } = this.weight;
      const words = Number.isFinite(size) ? `${isExact ? "" : "about "}${bytes(size)}` : "size not known in advance";
      this.size.textContent = `${words} as ${form}`;
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
