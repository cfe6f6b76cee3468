// Where the points of a panel come from, chunk by chunk: the server, or the worker.

import { ask } from "../api.js";
import { Chunks } from "../chunks.js";
import { decimalsFor, formatPlace, moved, place } from "../place.js";
import { joined, setOf } from "../query.js";
import { LAYER } from "../state.js";
import { callsOf } from "../worker.js";
import { MEASURED } from "./methods.js";

const make = callsOf("/page/compare/worker.js");

/** A window of a size around a place: its lower corner and its size. */
export function windowAround({ x, y }, width, height) {
  return { x: moved(x, -width / 2), y: moved(y, -height / 2), width, height };
}

export class Source {
  /** `method` is its id; `changed()` hears of points that have come, `failed(error)` of what is refused. */
  constructor(method, changed, failed) {
    this.method = method;
    this.isServed = method === "strew";
    this.seed = "";
    /** The number of points in the region of a method that has one, and the time of each, as far as it is known. */
    this.total = 0;
    this.nanoseconds = NaN;
    /** @type {import("../state.js").Layer} */
    this.layer = LAYER;
    /** @type {import("../chunks.js").Kind | undefined} */
    const kind = this.isServed ? undefined : {
      requestOf: (layers) => ({ path: `${method} ${layers[0].seed}` }),
      columnsOf: () => [],
      make: async (_, { size, cx, cy }) => {
        const { points } = await this.made({ x: place(cx * size), y: place(cy * size), width: size, height: size });
        return Float32Array.from(points);
      },
    };
    this.chunks = new Chunks(changed, failed, { kind });
  }

  use({ seed, profile }) {
    this.layer = { ...LAYER, seed: String(seed), profile };
    this.seed = this.isServed ? `${seed} ${profile}` : String(seed);
    this.chunks.show([this.layer]);
  }

  /** The points of a window that the worker makes. */
  async made(window) {
    const made = await make({ method: this.method, seed: Number(this.layer.seed), window });
    if (made.total) Object.assign(this, { total: made.total, nanoseconds: made.nanoseconds });
    return made;
  }

  /** The points of the measured square around a place, `null` if it is not all in the method's region. */
  async square(at) {
    const { x, y } = windowAround(at, MEASURED, MEASURED);
    if (!this.isServed) {
      const { points, isWhole } = await this.made({ x, y, width: MEASURED, height: MEASURED });
      return isWhole ? points : null;
    }
    const box = [x, y, moved(x, MEASURED), moved(y, MEASURED)].map((v) => formatPlace(v, decimalsFor(1e-9)));
    const answer = await ask(`/v1/points?bbox=${box.join(",")}&${joined([...setOf(this.layer), ["format", "f32"]])}`);
    return Float64Array.from(new Float32Array(await answer.arrayBuffer()));
  }
}
