// WebGL2: its context, programs and buffers.

/** The names of renderers without graphics hardware. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** The context of a canvas without transparency, or `null` where there is none. */
export function glOn(/** @type {HTMLCanvasElement} */ canvas, /** @type {WebGLContextAttributes} */ options) {
  const gl = canvas.getContext("webgl2", { alpha: false, stencil: false, powerPreference: "high-performance", ...options });
  return gl && !gl.isContextLost() ? gl : null;
}

/** Whether a processor does the work of graphics hardware. */
export function isSoftware(/** @type {WebGL2RenderingContext} */ gl) {
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  return SOFTWARE.test(String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER)));
}

/** A buffer with these contents. */
export function bufferOf(/** @type {WebGL2RenderingContext} */ gl, /** @type {AllowSharedBufferSource} */ contents) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, contents, gl.STATIC_DRAW);
  return buffer;
}

/**
 * A program of the sources of its two shaders: `{ program, uniforms }`, the uniforms by their names. `slots` names the
 * attributes that have slots, in their order; shaders that say their own need none.
 */
export function programOf(/** @type {WebGL2RenderingContext} */ gl, /** @type {string[]} */ [vertex, fragment], /** @type {string[]} */ slots = []) {
  const program = gl.createProgram();
  for (const [type, source] of /** @type {const} */ ([[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(type));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  slots.forEach((name, slot) => gl.bindAttribLocation(program, slot, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(gl.getAttachedShaders(program)?.map((shader) => gl.getShaderInfoLog(shader)).join("") || "no program");
  }
  /** @type {Record<string, WebGLUniformLocation | null>} */
  const uniforms = {};
  for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i += 1) {
    const { name } = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(program, i));
    uniforms[name] = gl.getUniformLocation(program, name);
  }
  return { program, uniforms };
}
