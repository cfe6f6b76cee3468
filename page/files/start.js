// The tab Start: three cards to begin with, three kinds of points side by side, and more views. Their places are in the
// page from the start; the pictures are drawn from the server's points when the plane is at rest.

import { ask } from "./api.js";
import { prepared, spectrumPicture } from "./charts.js";
import { runsOf } from "./chunks.js";
import { byId } from "./dom.js";
import { measure } from "./measure.js";
import { json } from "./digits.js";
import { Part } from "./part.js";
import { bodyOf, columnsOf, joined, setOf } from "./query.js";
import { isColored, tonesOf } from "./marks.js";
import { fromHash, initial } from "./state.js";
import { palette } from "./theme.js";

/** The points of each kind, and how many of them lie along a side. */
const ACROSS = 14;
const COUNT = ACROSS ** 2;

/** A set that repeats. */
const TILE = "periodic=5041&profile=blue&map=s&spacing=1&seed=7";

/**
 * Views to begin with: an address, and how the picture differs from points in a box. One with a `page` is a link to it;
 * `coarse` is the spacing of the picture, `photo` is shown instead, `isOpen` opens the plane with nothing before it.
 */
const VIEWS = [
  { id: "walk", page: "/walk", photo: "/page/forest.jpg" },
  { id: "portrait", hash: "#at=50,56&span=118&profile=blue&amount=0.42&seed=1&field=portrait&paper=1&dot=2", coarse: "0.6" },
  { id: "plane", hash: "#at=0,0&span=13&profile=blue&amount=1&seed=1", isOpen: true },
  {
    id: "forest",
    hash: "#at=-60,-5&span=100&layers=2&profile=blue&amount=3&seed=7&field=forest&color=9&dot=1.9&scale=1&range=0.6,1.2"
      + "&spread=chance&variants=oak:3,pine:2"
      + "&2.profile=spaced&2.amount=7&2.seed=4&2.field=forest&2.color=8&2.dot=1.5&2.scale=1&2.range=0.7,1.3&2.clear=2.4",
  },
  { id: "sampling", hash: "#at=0,0&span=64&profile=blue&amount=1&seed=3&tab=understand", hasSpectrum: true },
  { id: "tile", hash: "#at=0,0&span=24&profile=blue&amount=1&map=s&seed=7&color=1", page: "/tile" },
  {
    id: "detail",
    hash: "#at=0,0&span=56&layers=3&profile=blue&amount=1&seed=1&dot=0.5&2.amount=1&2.seed=1&2.color=1&2.dot=2&2.lod=0.0625"
      + "&3.amount=1&3.seed=1&3.color=2&3.dot=4&3.lod=0.00390625",
  },
];

/** Random numbers from 0 to 1 that a seed makes. */
function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let v = Math.imul(state ^ (state >>> 15), 1 | state);
    v = (v + Math.imul(v ^ (v >>> 7), 61 | v)) ^ v;
    return ((v ^ (v >>> 14)) >>> 0) / 2 ** 32;
  };
}

function whiteNoise(seed) {
  const next = random(seed);
  return Float64Array.from({ length: 2 * COUNT }, next);
}

function jitteredGrid(seed) {
  const next = random(seed);
  return Float64Array.from({ length: 2 * COUNT }, (_, i) => {
    const cell = i >> 1;
    return ((i % 2 === 0 ? cell % ACROSS : Math.floor(cell / ACROSS)) + next()) / ACROSS;
  });
}

/** As many points of the server: the lowest of a box a little higher than needed. */
async function strewn(seed) {
  const answer = await ask(`/v1/points?bbox=0,0,${ACROSS},${ACROSS + 3}&spacing=1&seed=${seed}&format=f32`);
  const packed = new Float32Array(await answer.arrayBuffer());
  const points = Array.from({ length: packed.length / 2 }, (_, k) => [packed[2 * k], packed[2 * k + 1]]);
  points.sort((a, b) => a[1] - b[1]);
  const height = points[COUNT][1];
  return Float64Array.from(points.slice(0, COUNT).flatMap(([x, y]) => [x / ACROSS, y / height]));
}

/** @type {[string, (seed: number) => any][]} */
const KINDS = [["white", whiteNoise], ["jitter", jitteredGrid], ["strew", strewn]];

export class Start extends Part {
  /** `opened()` is called when the plane alone is to be seen. */
  constructor(session, opened) {
    super();
    this.session = session;
    this.shows = opened;
    this.seed = 1;
    this.isFilled = false;
    /** @type {any[]} */
    this.trio = KINDS.map(([id]) => ({ id, canvas: byId(`kind-${id}`) }));
    this.views = VIEWS.map((view) => this.view(view));
    byId("kinds-again").addEventListener("click", () => {
      this.seed += 1;
      this.compare();
    });
  }

  view(view) {
    const element = byId(`view-${view.id}`);
    if (!view.page) {
      element.addEventListener("click", () => {
        this.session.choose((state) => {
          const { renderer } = state;
          Object.assign(state, view.isOpen ? { ...initial(), tab: "choose" } : fromHash(view.hash), { renderer });
        }, "layers", "view", "tab");
        if (view.isOpen) this.shows();
        else byId("choose").focus({ preventScroll: true });
      });
    }
    return { ...view, canvas: element.querySelector("canvas"), img: element.querySelector("img") };
  }

  get isOpen() {
    return this.session.state.tab === "start";
  }

  /** When the plane has its points, there is time for pictures. */
  rested() {
    if (!this.isOpen || this.isFilled) return;
    this.isFilled = true;
    this.fill();
  }

  opened() {
    if (document.documentElement.dataset.state === "ready") this.rested();
    else if (this.isFilled) this.themed();
  }

  themed() {
    if (!this.isFilled || !this.isOpen) return;
    for (const one of [...this.trio, ...this.views]) one.draw?.();
  }

  async fill() {
    const [cards, more] = [this.views.slice(0, 3), this.views.slice(3)];
    for (const view of cards) await this.picture(view).catch(() => {});
    await this.compare();
    for (const view of more) await this.picture(view).catch(() => {});
    document.documentElement.dataset.start = "ready";
  }

  async compare() {
    const { seed } = this;
    await Promise.all(this.trio.map(async (one, i) => {
      const points = await Promise.resolve(KINDS[i][1](seed)).catch(() => null);
      if (!points || seed !== this.seed) return;
      one.points = points;
      one.draw = () => dots(one.canvas, points);
      one.draw();
    }));
  }

  /** Draws what a view opens, from the server's points. */
  async picture(view) {
    if (view.photo) {
      view.img.src = view.photo;
      return view.img.decode();
    }
    const { layers, x, y, span } = fromHash(view.hash);
    // A small picture needs fewer points.
    if (view.coarse) layers[0].amount = view.coarse;
    const across = view.hasSpectrum ? 24 : span * SHOWN;
    const half = [across / 2, across / 2 / ASPECT];
    const box = [x.i - half[0], y.i - half[1], x.i + half[0], y.i + half[1]];
    if (view.page) {
      const chunk = { data: await aroundCorner(across), stride: 2, columns: [], layers };
      chunk.count = chunk.data.length / 2;
      view.draw = () => draw(view, chunk, across);
      return view.draw();
    }
    const answer = await pointsOf(layers, box);
    const columns = columnsOf(layers);
    const stride = 2 + columns.length;
    const data = new Float32Array(await answer.arrayBuffer());
    const chunk = { data, stride, columns, layers, count: data.length / stride };
    if (view.hasSpectrum) view.measured = await spectrumFor(layers[0]);
    view.draw = () => draw(view, chunk, across);
    return view.draw();
  }
}

/** The points around a corner where four tiles meet, from the lower corner of the picture. */
async function aroundCorner(across) {
  const answer = await ask(`/v1/points?${TILE}&format=f32`);
  const packed = new Float32Array(await answer.arrayBuffer());
  const side = Math.sqrt(packed.length / 2);
  const half = [across / 2, across / 2 / ASPECT];
  const found = [];
  for (let k = 0; k < packed.length; k += 2) {
    const [x, y] = [0, 1].map((i) => packed[k + i] - (packed[k + i] > side / 2 ? side : 0) + half[i]);
    if (x >= 0 && y >= 0 && x < across && y < across / ASPECT) found.push(x, y);
  }
  return Float32Array.from(found);
}

/** Pictures are this much wider than high; they show this share of the span of their view. */
const ASPECT = 1.5;
const SHOWN = 0.8;
/** The side of the window that the spectrum of a picture is made from, in mean spacings. */
const WINDOW = 40;

async function spectrumFor(layer) {
  const answer = await ask(`/v1/points?bbox=0,0,${WINDOW},${WINDOW}&${joined(setOf(layer))}&format=f32`);
  return measure(Float64Array.from(new Float32Array(await answer.arrayBuffer())), WINDOW);
}

/** The points of layers in a box, packed, with x and y from its lower corner. */
function pointsOf(layers, box) {
  if (layers.length > 1) return ask("/v1/points:query", { body: json(bodyOf(layers, { bbox: box }, 1, { format: "f32" })) });
  return ask(`/v1/points?bbox=${box.join(",")}&${joined(setOf(layers[0]))}&format=f32`);
}

/** Draws a view's points: each layer in its color, dots as large as they are far apart. */
function draw(view, chunk, across) {
  const { context, width, height } = prepared(view.canvas, 1 / ASPECT);
  const { ground, colors } = palette(chunk.layers);
  const css = (rgb) => `rgb(${rgb.map((v) => Math.round(v * 255)).join(" ")})`;
  context.fillStyle = css(ground);
  context.fillRect(0, 0, width, height);
  const pixel = width / across;
  const { data, stride, columns } = chunk;
  const [scale, kind] = ["scale", "variant"].map((name) => 2 + columns.indexOf(name));
  for (const { layer: index, first, count } of runsOf(chunk)) {
    const layer = chunk.layers[index];
    const tones = isColored(layer) ? tonesOf(chunk.layers, index, colors) : null;
    const gap = Number(layer.amount) * pixel;
    for (let k = first; k < first + count; k += 1) {
      const [x, y] = [data[k * stride] * pixel, height - data[k * stride + 1] * pixel];
      const grow = layer.scale ? data[k * stride + scale] : 1;
      const radius = Math.max(0.5, Math.min(4, gap * 0.15 * grow * layer.dot));
      context.fillStyle = css(tones ? tones[data[k * stride + kind] % tones.length] : colors[layer.color]);
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fill();
    }
  }
  if (view.page) {
    context.strokeStyle = css(colors[2]);
    context.setLineDash([4, 4]);
    context.strokeRect(width / 2, -1, width, height / 2 + 1);
    context.strokeRect(-1, height / 2, width / 2 + 1, height);
  }
  if (view.measured) {
    const spectrum = document.createElement("canvas");
    spectrumPicture(spectrum, view.measured.image, view.measured.cells);
    context.drawImage(spectrum, width - height, 0, height, height);
  }
}

/** Draws points of a unit square as dots. */
function dots(canvas, points) {
  const { context, width } = prepared(canvas, 1);
  context.fillStyle = getComputedStyle(document.body).backgroundColor;
  context.fillRect(0, 0, width, width);
  context.fillStyle = getComputedStyle(document.body).color;
  context.beginPath();
  const radius = (width / ACROSS) * 0.17;
  for (let p = 0; p < points.length; p += 2) {
    const [x, y] = [points[p] * width, width - points[p + 1] * width];
    context.moveTo(x + radius, y);
    context.arc(x, y, radius, 0, 2 * Math.PI);
  }
  context.fill();
}
