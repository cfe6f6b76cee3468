// The picture by WebGL2: sky, ground, shadows, and everything that stands, a draw for each kind and leaf. Instances go
// to the graphics processor once; which of them are drawn is a beginning of each run, as these are sorted by rank.

import { firstOf } from "../bisect.js";
import { bufferOf, glOn, isSoftware, programOf } from "../program.js";
import { sized } from "../view.js";
import { sees } from "./camera.js";
import { GROUND_FLOATS, INSTANCE_FLOATS, netOf } from "./ground.js";
import { GROUND, SHADOWS, SKY, THINGS } from "./shaders.js";
import { KINDS, VERTEX_FLOATS, allShapes } from "./shapes.js";

/** What kinds do in the wind, and the shadows that they cast: half of their width and how tall, for a height of 1. */
const SWAY = [0.04, 0.035, 0, 0.02, 0.06, 0.06, 0.05];
const CAST = [[0.17, 0.8], [0.3, 0.85], [0.6, 0.5], [0.6, 0.6]];

/** Within this distance, in units, things cast shadows. */
const SHADED = 140;

const LIGHTS = {
  day: {
    zenith: [0.13, 0.34, 0.66], horizon: [0.60, 0.74, 0.83], glow: [0.30, 0.24, 0.13], sun: [0.55, 0.55, 0.5],
    daylight: [1.25, 1.12, 0.86], ambient: [0.42, 0.52, 0.66], bounce: [0.20, 0.19, 0.10], stars: 0, dark: 0.42,
  },
  dusk: {
    zenith: [0.010, 0.017, 0.055], horizon: [0.21, 0.105, 0.115], glow: [0.60, 0.23, 0.08], sun: [0.2, 0.95, 0.13],
    daylight: [0.72, 0.30, 0.14], ambient: [0.085, 0.10, 0.19], bounce: [0.05, 0.04, 0.05], stars: 0.8, dark: 0.25,
  },
};

/** A scene on a canvas, or `null` where there is no WebGL2. */
export function sceneOn(canvas) {
  const gl = glOn(canvas, { antialias: true, depth: true });
  return gl && new Scene(gl, canvas);
}

class Scene {
  isBlind = false;

  constructor(/** @type {WebGL2RenderingContext} */ gl, /** @type {HTMLCanvasElement} */ canvas) {
    this.gl = gl;
    this.canvas = canvas;
    this.isSlow = isSoftware(gl);
    this.programs = Object.fromEntries(
      Object.entries({ SKY, GROUND, THINGS, SHADOWS }).map(([name, source]) => [name, programOf(gl, source)]),
    );
    this.shapes = allShapes();
    this.vertices = this.buffer(this.shapes.floats);
    this.nets = new Map();
    this.mode = "day";
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** A buffer with these contents. */
  buffer(contents) {
    return bufferOf(this.gl, contents);
  }

  free(buffer) {
    this.gl.deleteBuffer(buffer);
  }

  /** The triangles of nets with a number of cells along a side. */
  net(cells) {
    if (!this.nets.has(cells)) {
      const { gl } = this;
      const [indices, buffer] = [netOf(cells), gl.createBuffer()];
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
      this.nets.set(cells, { buffer, count: indices.length });
    }
    return this.nets.get(cells);
  }

  /** Makes the picture as large as its canvas on the screen, with `ratio` pixels to a CSS pixel. */
  resize(ratio) {
    const { canvas } = this;
    sized(canvas, [canvas.clientWidth, canvas.clientHeight].map((v) => Math.max(1, Math.round(v * ratio))));
  }

  /**
   * Draws what `look` has: the camera, `lift` (its height), `grounds` and `things` as `{ leaf, clip, ... }`, `reach`,
   * `time`, and `detail`, the distances within which leaves have all of their triangles and some of them. Returns how
   * many instances were drawn.
   */
  draw(look) {
    const { gl } = this;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.CULL_FACE);
    this.drawGround(look);
    if (look.isFine) this.drawShadows(look);
    gl.disable(gl.CULL_FACE);
    const drawn = this.drawThings(look);
    this.drawSky(look);
    return drawn;
  }

  use(name, look) {
    const { gl } = this;
    const { program, uniforms } = this.programs[name];
    gl.useProgram(program);
    const light = LIGHTS[this.mode];
    const sun = light.sun.map((v) => v / Math.hypot(...light.sun));
    for (const [key, value] of Object.entries({ ...light, sun, reach: look.reach })) {
      if (!uniforms[key]) continue;
      if (Array.isArray(value)) gl.uniform3fv(uniforms[key], value);
      else gl.uniform1f(uniforms[key], value);
    }
    if (uniforms.view) gl.uniformMatrix4fv(uniforms.view, false, look.camera.matrix);
    return uniforms;
  }

  drawSky(look) {
    const { gl } = this;
    const uniforms = this.use("SKY", look);
    const { right, up, ahead, wide, tall } = look.camera;
    gl.uniform3fv(uniforms.right, right.map((v) => v * wide));
    gl.uniform3fv(uniforms.up, up.map((v) => v * tall));
    gl.uniform3fv(uniforms.ahead, ahead);
    for (let slot = 0; slot < 6; slot += 1) gl.disableVertexAttribArray(slot);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  /** Sets slots to `[slot, floats]` of records from a byte on. */
  slots(buffer, stride, offset, list, divisor) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    let at = offset;
    for (const [slot, floats] of list) {
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, floats, gl.FLOAT, false, 4 * stride, at);
      gl.vertexAttribDivisor(slot, divisor);
      at += 4 * floats;
    }
  }

  drawGround(look) {
    const { gl } = this;
    const uniforms = this.use("GROUND", look);
    gl.uniform1f(uniforms.fine, look.isFine ? 1 : 0);
    for (const { leaf, ground, buffer } of look.grounds) {
      if (!sees(look.camera, leaf.from, leaf.size, look.lift)) continue;
      const { buffer: indices, count } = this.net(ground.cells);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
      this.slots(buffer, GROUND_FLOATS, 0, [[0, 3], [1, 3], [2, 2]], 0);
      gl.uniform3f(uniforms.corner, leaf.from[0], leaf.from[1], -look.height);
      gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_SHORT, 0);
    }
  }

  /** The runs that can be seen, as `visit(thing, run, count)`, kind by kind. */
  runs(look, kinds, visit) {
    const seen = look.things.filter(({ leaf }) => sees(look.camera, leaf.from, leaf.size, look.lift));
    for (let kind = 0; kind < kinds; kind += 1) {
      for (const thing of seen) {
        const run = thing.runs.find((one) => one.kind === kind);
        if (!run) continue;
        const share = Math.min(1, (thing.near / Math.max(thing.leaf.away, 1e-9)) ** 2);
        const count = share < 1 ? firstOf(run.ranks.length, (k) => run.ranks[k] >= share) : run.ranks.length;
        if (count > 0) visit(thing, run, count);
      }
    }
  }

  place(uniforms, look, { leaf, clip, near }) {
    const { gl } = this;
    gl.uniform3f(uniforms.corner, leaf.from[0], leaf.from[1], -look.height);
    gl.uniform3fv(uniforms.clip, clip ?? [0, 0, 0]);
    gl.uniform2f(uniforms.near, near, leaf.keep);
  }

  drawShadows(look) {
    const { gl } = this;
    const uniforms = this.use("SHADOWS", look);
    gl.enable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.depthMask(false);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(-2, -4);
    for (let slot = 0; slot < 3; slot += 1) gl.disableVertexAttribArray(slot);
    this.runs(look, CAST.length, (thing, run, count) => {
      if (thing.leaf.away > SHADED) return;
      this.place(uniforms, look, thing);
      gl.uniform1f(uniforms.wide, CAST[run.kind][0]);
      gl.uniform1f(uniforms.tall, CAST[run.kind][1]);
      this.slots(thing.buffer, INSTANCE_FLOATS, 4 * INSTANCE_FLOATS * run.first, [[3, 4], [4, 4], [5, 2]], 1);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    });
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.disableVertexAttribArray(5);
  }

  drawThings(look) {
    const { gl } = this;
    const uniforms = this.use("THINGS", look);
    gl.uniform1f(uniforms.time, look.time);
    this.slots(this.vertices, VERTEX_FLOATS, 0, [[0, 3], [1, 3], [2, 3]], 0);
    let drawn = 0;
    this.runs(look, KINDS.length, (thing, run, count) => {
      this.place(uniforms, look, thing);
      gl.uniform1f(uniforms.sway, SWAY[run.kind]);
      gl.uniform1f(uniforms.kind, run.kind);
      const [full, some] = look.detail;
      const { near, far, plain } = this.shapes;
      const shapes = thing.leaf.away < full ? near : thing.leaf.away < some ? far : plain;
      this.slots(thing.buffer, INSTANCE_FLOATS, 4 * INSTANCE_FLOATS * run.first, [[3, 4], [4, 4]], 1);
      gl.drawArraysInstanced(gl.TRIANGLES, shapes[run.kind][0], shapes[run.kind][1], count);
      drawn += count;
    });
    return drawn;
  }
}
