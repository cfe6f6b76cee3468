// The volume by WebGL2: each chunk is a buffer of points, drawn as lit dots that shrink and pale with distance.

import { bufferOf, glOn, programOf } from "../program.js";

/** Half of a dot's width in mean spacings. */
const RADIUS = 0.13;
/** The share of the reach within which dots have their whole size; from there they shrink to nothing. */
const WHOLE = 0.72;

const DOTS = [`#version 300 es
in vec3 place;
uniform mat4 matrix;
uniform vec3 corner, middle, near_color, far_color, ground;
uniform float scale, reach, lens;
uniform vec2 depths;
flat out vec3 color;
flat out float radius;
void main() {
  vec3 at = corner + place * scale;
  vec3 off = at - middle;
  gl_Position = matrix * vec4(at, 1.0);
  float depth = gl_Position.w;
  float edge = 1.0 - smoothstep(${WHOLE} * reach, reach, length(off));
  radius = ${RADIUS} * lens / max(depth, 0.1) * sqrt(edge) * smoothstep(0.3, 1.5, depth);
  float far = clamp((depth - depths.x) / (depths.y - depths.x), 0.0, 1.0);
  // What is smaller than a pixel is paler instead.
  float faint = min(1.0, radius * 1.6);
  color = mix(ground, mix(near_color, far_color, far), faint * (1.0 - 0.88 * far) * smoothstep(0.0, 0.15, edge));
  gl_PointSize = edge > 0.0 ? max(1.0, 2.0 * radius + 1.0) : 0.0;
  if (edge <= 0.0 || depth < 0.3) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`, `#version 300 es
precision highp float;
flat in vec3 color;
flat in float radius;
out vec4 result;
void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  float away = length(at) * (radius + 0.5);
  float cover = radius < 0.7 ? 1.0 : clamp(radius + 0.5 - away, 0.0, 1.0);
  if (cover < 0.05) discard;
  float up = sqrt(max(0.0, 1.0 - dot(at, at)));
  float light = dot(vec3(at.x, -at.y, up), vec3(-0.42, 0.56, 0.71));
  float shade = radius < 1.5 ? 0.0 : clamp(0.75 - light, 0.0, 1.0) * 0.6;
  result = vec4(mix(color, color * 0.25, shade), cover);
}`];

const LINES = [`#version 300 es
in vec3 place;
uniform mat4 matrix;
uniform vec3 corner;
uniform float scale;
void main() { gl_Position = matrix * vec4(corner + place * scale, 1.0); }`, `#version 300 es
precision mediump float;
uniform vec3 color;
out vec4 result;
void main() { result = vec4(color, 1.0); }`];

/** The ends of the edges of a cube. */
const EDGES = [0, 1, 2].flatMap((axis) => [[0, 0], [0, 1], [1, 0], [1, 1]].flatMap((rest) => (
  [0, 1].map((end) => [...rest.slice(0, axis), end, ...rest.slice(axis)])
)));

/** A scene on a canvas, or `null` where there is no WebGL2. */
export function sceneOn(/** @type {HTMLCanvasElement} */ canvas) {
  const gl = glOn(canvas, { antialias: true, depth: true });
  return gl && new Scene(gl, canvas);
}

/**
 * Colors by what they are for: red, green and blue from 0 to 1.
 * @typedef {Record<"ground" | "near" | "far" | "line", number[]>} Colors
 */

class Scene {
  constructor(/** @type {WebGL2RenderingContext} */ gl, /** @type {HTMLCanvasElement} */ canvas) {
    this.gl = gl;
    this.canvas = canvas;
    this.dots = programOf(gl, DOTS, ["place"]);
    this.lines = programOf(gl, LINES, ["place"]);
    this.cube = bufferOf(gl, new Float32Array(EDGES.flat()));
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    gl.enableVertexAttribArray(0);
  }

  /** The buffer of a chunk, which goes when the chunk is dropped. */
  bufferOf(chunk) {
    if (!chunk.buffer) {
      chunk.buffer = bufferOf(this.gl, chunk.data);
      chunk.dropped = () => {
        this.gl.deleteBuffer(chunk.buffer);
        chunk.buffer = null;
      };
    }
    return chunk.buffer;
  }

  /** @param {Record<string, any>} seen */
  draw({ camera, chunks, scale, middle, reach, depths, box, colors }) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    const [red, green, blue] = colors.ground;
    gl.clearColor(red, green, blue, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const { program, uniforms } = this.dots;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.matrix, false, camera.matrix);
    gl.uniform3fv(uniforms.middle, middle);
    gl.uniform3fv(uniforms.near_color, colors.near);
    gl.uniform3fv(uniforms.far_color, colors.far);
    gl.uniform3fv(uniforms.ground, colors.ground);
    gl.uniform2fv(uniforms.depths, depths);
    gl.uniform1f(uniforms.scale, scale);
    gl.uniform1f(uniforms.reach, reach);
    gl.uniform1f(uniforms.lens, canvas.height / 2 / camera.tall);
    for (const { chunk, corner } of chunks) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.bufferOf(chunk));
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 4 * chunk.stride, 0);
      gl.uniform3fv(uniforms.corner, corner);
      gl.drawArrays(gl.POINTS, 0, chunk.count);
    }
    if (box) this.drawBox(camera, box, colors.line);
  }

  drawBox({ matrix }, { corner, side }, color) {
    const { gl } = this;
    const { program, uniforms } = this.lines;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.matrix, false, matrix);
    gl.uniform3fv(uniforms.corner, corner);
    gl.uniform1f(uniforms.scale, side);
    gl.uniform3fv(uniforms.color, color);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.cube);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    // The outline shows through the dots.
    gl.disable(gl.DEPTH_TEST);
    gl.drawArrays(gl.LINES, 0, EDGES.length);
    gl.enable(gl.DEPTH_TEST);
  }
}
