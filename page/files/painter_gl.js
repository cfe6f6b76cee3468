// Points by WebGL2. Each chunk's records go into a buffer of their own as they arrive; sheets are
// textures, so that a frame of a drag is a copy and not another drawing of all points.

import { ARROW, SHAPES, isMarked, slotsOf } from "./marks.js";
import { glOn, isSoftware, programOf } from "./program.js";

/** The attributes by their slots. */
const SLOTS = ["place", "angle", "scale", "variant"];

/** The most kinds that have colors of their own. */
const TONES = 32;

const VERTEX = `#version 300 es
in vec2 place;
in float angle, scale, variant;
uniform vec2 corner, half_size;
uniform float zoom, size;
uniform float shapes;
uniform vec3 color, tones[${TONES}];
uniform int kinds;
flat out float shape, radius;
flat out vec3 ink;
flat out vec2 turn;
void main() {
  gl_Position = vec4((corner + place * zoom) / half_size, 0.0, 1.0);
  radius = 0.5 * size * scale;
  gl_PointSize = 2.0 * radius + 1.0;
  shape = shapes < 0.0 ? -shapes : mod(variant, shapes);
  turn = vec2(cos(angle), sin(angle));
  ink = kinds > 0 ? tones[int(variant) % kinds] : color;
}`;

const DOT = `#version 300 es
precision mediump float;
flat in float radius;
flat in vec3 ink;
out vec4 result;
void main() {
  float away = length(gl_PointCoord - 0.5) * (2.0 * radius + 1.0);
  float cover = clamp(radius + 0.5 - away, 0.0, 1.0);
  result = vec4(ink * cover, cover);
}`;

const MARK = `#version 300 es
precision highp float;
flat in float shape, radius;
flat in vec2 turn;
flat in vec3 ink;
out vec4 result;
float box(vec2 p, vec2 reach) {
  vec2 d = abs(p) - reach;
  return max(d.x, d.y);
}
void main() {
  vec2 at = (gl_PointCoord - 0.5) * (2.0 * radius + 1.0);
  at.y = -at.y;
  vec2 p = vec2(dot(at, turn), dot(at, vec2(-turn.y, turn.x))) / radius;
  float d;
  bool is_open = shape > 5.5 && shape < 8.5;
  float kind = is_open ? shape - 5.0 : shape;
  if (kind < 0.5) d = length(p) - 0.72;
  else if (kind < 1.5) d = max(-p.x - 0.5, abs(p.y) * 0.8660 + p.x * 0.5 - 0.46);
  else if (kind < 2.5) d = box(p, vec2(0.62));
  else if (kind < 3.5) d = (abs(p.x) + abs(p.y) - 0.92) * 0.7071;
  else if (kind < 4.5) d = min(box(p, vec2(0.82, 0.25)), box(p, vec2(0.25, 0.82)));
  else if (kind < 5.5) d = abs(length(p) - 0.62) - 0.16;
  else if (kind < 9.5) d = box(p, vec2(0.9, 0.24));
  else {
    float shaft = box(p + vec2(0.3, 0.0), vec2(0.65, 0.1));
    float head = max(0.1 - p.x, abs(p.y) * 0.88 + p.x * 0.47 - 0.44);
    d = min(shaft, head);
  }
  if (is_open) d = max(d, -d - 0.25);
  float cover = clamp(0.5 - d * radius, 0.0, 1.0);
  result = vec4(ink * cover, cover);
}`;

/** Whether WebGL2 is there and is done by hardware; looked at on a canvas that is thrown away. */
function isFast() {
  const gl = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
  if (!gl) return false;
  const isHardware = !isSoftware(gl);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return isHardware;
}

/**
 * A painter, or `null` where there is no WebGL2; also where a processor would have to do it, which is
 * slower than a plain canvas, unless it is `wanted`.
 */
export function glPainter(canvas, wanted) {
  if (!wanted && !isFast()) return null;
  const gl = glOn(canvas, { antialias: false, depth: false });
  return gl && new GlPainter(gl, canvas);
}

class GlPainter {
  constructor(gl, canvas) {
    this.gl = gl;
    this.canvas = canvas;
    this.name = "webgl2";
    /** Points painted in a frame at most: what a renderer without graphics hardware can do. */
    this.budget = 200_000;
    this.slice = 50_000;
    this.dots = programOf(gl, [VERTEX, DOT], SLOTS);
    this.marks = programOf(gl, [VERTEX, MARK], SLOTS);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  }

  /** An empty sheet of a size in device pixels. */
  sheet(width, height) {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
    const target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return { width, height, texture, target };
  }

  drop(sheet) {
    this.gl.deleteFramebuffer(sheet.target);
    this.gl.deleteTexture(sheet.texture);
  }

  clear(sheet, ground) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, sheet.target);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /** Ends the painting of a frame: nothing is held back here. */
  flush() {}

  /** Sends what has arrived of a chunk and was not sent yet. */
  upload(chunk) {
    const { gl } = this;
    if (!chunk.buffer) {
      chunk.buffer = gl.createBuffer();
      chunk.uploaded = 0;
      gl.bindBuffer(gl.ARRAY_BUFFER, chunk.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, Math.max(4, chunk.data.byteLength), gl.STATIC_DRAW);
      chunk.dropped = () => {
        gl.deleteBuffer(chunk.buffer);
        chunk.buffer = null;
        chunk.dropped = null;
      };
    } else gl.bindBuffer(gl.ARRAY_BUFFER, chunk.buffer);
    if (chunk.uploaded < chunk.count) {
      const [from, to] = [chunk.uploaded * chunk.stride, chunk.count * chunk.stride];
      gl.bufferSubData(gl.ARRAY_BUFFER, 4 * from, chunk.data, from, to - from);
      chunk.uploaded = chunk.count;
    }
  }

  /**
   * Paints some of a chunk's points. `corner` is where its corner is from the middle of the sheet, in
   * device pixels with y upward; `zoom` is pixels per unit of the world.
   */
  paint(sheet, chunk, { layer, first, count, corner, zoom, size, color, tones }) {
    const { gl } = this;
    const isMark = isMarked(layer);
    const { program, uniforms } = isMark ? this.marks : this.dots;
    gl.bindFramebuffer(gl.FRAMEBUFFER, sheet.target);
    gl.viewport(0, 0, sheet.width, sheet.height);
    gl.useProgram(program);
    this.upload(chunk);
    const bytes = 4 * chunk.stride;
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, bytes, 0);
    const slots = slotsOf(layer, chunk.columns);
    ["angle", "scale", "variant"].forEach((name, i) => {
      if (slots[name] < 0) {
        gl.disableVertexAttribArray(i + 1);
        gl.vertexAttrib1f(i + 1, name === "scale" ? 1 : 0);
      } else {
        gl.enableVertexAttribArray(i + 1);
        gl.vertexAttribPointer(i + 1, 1, gl.FLOAT, false, bytes, 4 * slots[name]);
      }
    });
    gl.uniform2f(uniforms.corner, corner[0], corner[1]);
    gl.uniform2f(uniforms.half_size, sheet.width / 2, sheet.height / 2);
    gl.uniform1f(uniforms.zoom, zoom);
    gl.uniform1f(uniforms.size, size);
    gl.uniform1f(uniforms.shapes, layer.variant ? SHAPES.length : -ARROW);
    gl.uniform3f(uniforms.color, ...color);
    const kinds = tones?.slice(0, TONES) ?? [];
    gl.uniform1i(uniforms.kinds, kinds.length);
    if (kinds.length > 0) gl.uniform3fv(uniforms["tones[0]"], kinds.flat());
    gl.drawArrays(gl.POINTS, first, count);
  }

  /** Begins a frame. */
  begin(ground) {
    const { gl } = this;
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /**
   * Copies a sheet onto the canvas: its middle goes to `x`, `y` from the canvas's middle (y upward),
   * enlarged by `scale`; only inside of `rect` (left, bottom, width, height), if that is given.
   */
  show(sheet, { x, y, scale, rect }) {
    const { gl, canvas } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, sheet.target);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    if (rect) {
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(...rect);
    } else gl.disable(gl.SCISSOR_TEST);
    const left = Math.round(canvas.width / 2 + x - (sheet.width / 2) * scale);
    const low = Math.round(canvas.height / 2 + y - (sheet.height / 2) * scale);
    const right = left + Math.round(sheet.width * scale);
    const high = low + Math.round(sheet.height * scale);
    const filter = scale === 1 ? gl.NEAREST : gl.LINEAR;
    gl.blitFramebuffer(0, 0, sheet.width, sheet.height, left, low, right, high, gl.COLOR_BUFFER_BIT, filter);
  }

  /** Waits until all is on the canvas: for measuring. */
  finish() {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, null);
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }
}
