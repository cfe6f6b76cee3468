// The tab Take: the points in view, or what repeats, as a file and as a request to paste.

import { hasKey, isAborted, wordsOf } from "./api.js";
import { FORMATS, MOST_HELD, curl, looksOf, python, requestOf, save, sizeOf } from "./commands.js";
import { byId, bytes, copy, counted, settled } from "./dom.js";
import { setOptions } from "./form.js";
import { boxOf, joined } from "./query.js";
import { Repeat } from "./repeat.js";
import { countIn } from "./status.js";

/** What can be taken away, as the address has it. */
const WHAT = [["", "The points in view"], ["tile", "A tile that repeats without a seam"], ["mask", "A mask for dithering, which repeats"]];
/** How a request is written. */
const WAYS = ["curl", "python", "url"];

export class Take {
  constructor(session, plane) {
    this.session = session;
    this.plane = plane;
    this.way = "curl";
    this.size = byId("take-size");
    this.button = byId("download");
    this.bar = byId("take-bar");
    this.format = "csv";
    this.isThinned = true;
    /** @type {{ bytes: number, isExact: boolean } | null} */
    this.weight = null;
    this.again = settled(250, () => this.weigh());
    byId("take-what").addEventListener("change", () => session.choose((state) => (state.take = byId("take-what").value), "tab"));
    this.repeat = new Repeat(() => this.again());
    byId("take-thinned").addEventListener("change", () => {
      this.isThinned = byId("take-thinned").checked;
      this.rested();
    });
    setOptions(byId("format"), FORMATS.map(([name, , use]) => [name, `${name} — ${use}`]), this.format);
    byId("format").addEventListener("change", () => {
      this.format = byId("format").value;
      this.rested();
    });
    for (const way of WAYS) {
      byId(`way-${way}`).addEventListener("click", () => {
        this.way = way;
        this.render();
      });
    }
    byId("copy").addEventListener("click", () => copy(byId("command"), byId("copy")));
    byId("download").addEventListener("click", () => this.download());
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
    setOptions(byId("take-what"), layers[0].world ? WHAT.slice(0, 1) : WHAT, repeats);
    byId("take-repeat").hidden = !repeats;
    byId("take-thin").hidden = Boolean(repeats) || this.plane.keep >= 1;
    byId("take-format").hidden = repeats === "mask";
    const { request } = this;
    const texts = {
      curl: () => curl(location.origin, request, this.file),
      python: () => python(location.origin, request, this.form, this.file),
      url: () => (request.body ? `POST ${location.origin}${request.path}\n\n${request.body}` : location.origin + request.path),
    };
    byId("command").textContent = texts[this.way]();
    for (const id of WAYS) byId(`way-${id}`).setAttribute("aria-pressed", String(id === this.way));
    byId("take-help").textContent = {
      curl: "For a shell.",
      python: this.form === "npy" ? "For Python 3 with numpy." : "For Python 3, with nothing installed.",
      url: request.body ? "Several layers, and fields that were sent, need a body, which an address cannot hold." : "For a browser, or anything else that reads addresses.",
    }[this.way];
    if (hasKey()) byId("take-help").textContent += " Add your key, as the header “Authorization: Bearer …”.";
    byId("copy").textContent = "Copy";
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
      byId("take-count").textContent = repeats === "mask" ? "" : counted(this.count);
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
