// The programs of the graphics processor. Colors are squared for the light and rooted at the end, which is near enough to
// linear light.

/** The sky, and the haze that everything fades into. */
const AIR = `
uniform vec3 zenith, horizon, glow, sun;
uniform float reach;
vec3 sky(vec3 way) {
  float above = max(way.z, 0.0);
  float facing = max(dot(way, sun), 0.0);
  vec3 color = mix(horizon, zenith, pow(above, 0.55));
  return color + glow * (0.55 * pow(facing, 6.0) + 0.35 * pow(facing, 60.0));
}
vec3 hazed(vec3 color, vec3 from) {
  float away = length(from) / reach;
  vec3 way = normalize(vec3(from.xy, max(from.z, 0.0) + 0.02 * length(from)));
  return mix(color, sky(way), 1.0 - exp(-3.2 * away * away));
}
vec4 shown(vec3 color) { return vec4(sqrt(color), 1.0); }`;

const LIGHT = `
uniform vec3 daylight, ambient, bounce;
vec3 lit(vec3 color, vec3 normal, float direct) {
  vec3 around = mix(bounce, ambient, 0.5 + 0.5 * normal.z);
  return color * (around + daylight * direct * max(dot(normal, sun), 0.0));
}`;

export const SKY = [`#version 300 es
const vec2 CORNERS[3] = vec2[3](vec2(-1.0, -1.0), vec2(3.0, -1.0), vec2(-1.0, 3.0));
uniform vec3 right, up, ahead;
out vec3 way;
void main() {
  vec2 at = CORNERS[gl_VertexID];
  way = ahead + right * at.x + up * at.y;
  gl_Position = vec4(at, 1.0, 1.0);
}`, `#version 300 es
precision highp float;
in vec3 way;
out vec4 result;
uniform float stars;
${AIR}
void main() {
  vec3 at = normalize(way);
  vec3 color = sky(at) + glow * 6.0 * smoothstep(0.9994, 0.9997, dot(at, sun));
  vec3 cell = floor(at * 190.0);
  float chance = fract(sin(dot(cell, vec3(12.99, 78.23, 37.72))) * 43758.5);
  float spot = 1.0 - 2.0 * length(fract(at * 190.0) - 0.5);
  color += stars * step(0.9965, chance) * max(spot, 0.0) * smoothstep(0.1, 0.5, at.z);
  result = shown(color);
}`];

export const GROUND = [`#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 cover;
uniform mat4 view;
uniform vec3 corner;
out vec3 from, facing;
out vec2 local, covered;
void main() {
  from = corner + place;
  facing = normal;
  local = place.xy;
  covered = cover;
  gl_Position = view * vec4(from, 1.0);
}`, `#version 300 es
precision highp float;
in vec3 from, facing;
in vec2 local, covered;
uniform float fine;
out vec4 result;
${AIR}${LIGHT}
float chance(vec2 cell) {
  vec2 c = mod(cell, 64.0);
  return fract(sin(dot(c, vec2(12.9898, 78.233))) * 43758.5453);
}
// Repeats after 64 cells, which corners of squares are multiples of.
float grain(vec2 at) {
  vec2 cell = floor(at), f = at - cell;
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(chance(cell), chance(cell + vec2(1, 0)), f.x),
             mix(chance(cell + vec2(0, 1)), chance(cell + vec2(1, 1)), f.x), f.y);
}
void main() {
  vec3 normal = normalize(facing);
  float away = length(from);
  float rough = grain(local);
  if (fine > 0.5) rough = mix(mix(rough, 0.5 * rough + 0.5 * grain(local * 4.0), exp(-away * 0.03)), 0.5, 1.0 - exp(-away * 0.006));
  float woods = smoothstep(0.05, 0.5, covered.x + 0.2 * (rough - 0.5));
  vec3 color = mix(mix(vec3(0.30, 0.36, 0.10), vec3(0.42, 0.45, 0.16), rough), mix(vec3(0.115, 0.16, 0.06), vec3(0.19, 0.21, 0.09), rough), woods);
  color = mix(color, mix(vec3(0.09, 0.145, 0.06), vec3(0.12, 0.18, 0.075), rough), woods * smoothstep(60.0, 220.0, away));
  float bare = smoothstep(0.86, 0.74, normal.z + 0.05 * (rough - 0.5));
  color = mix(color, vec3(0.36, 0.34, 0.31) * (0.8 + 0.4 * rough), bare);
  float way = abs(covered.y) + 0.5 * (rough - 0.5);
  color = mix(vec3(0.52, 0.42, 0.28) * (0.85 + 0.3 * rough), color, smoothstep(0.55, 1.15, way));
  result = shown(hazed(lit(color * color * 2.2, normal, 1.0), from));
}`];

/** How large a thing is of what it will be: what is about to leave the share that is drawn is small, what is outside of the square gone. */
const GROWN = `
uniform mat4 view;
uniform vec3 corner, clip;
uniform vec2 near;
float grownAt(vec2 foot, float rank) {
  // The share that is drawn falls with the square of the distance.
  float share = min(near.x * near.x / dot(foot, foot), near.y);
  vec2 inside = foot - clip.xy;
  if (clip.z > 0.0 && (any(lessThan(inside, vec2(0.0))) || any(greaterThanEqual(inside, vec2(clip.z))))) return 0.0;
  return share >= 1.0 ? 1.0 : clamp(5.0 * (share - rank) / share, 0.0, 1.0);
}`;

export const THINGS = [`#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 color;
layout(location = 3) in vec4 stand;
layout(location = 4) in vec4 traits;
uniform float time, sway, kind;
out vec3 from, facing, tone;
${GROWN}
void main() {
  vec3 foot = corner + stand.xyz;
  float grown = grownAt(foot.xy, traits.w);
  float size = stand.w * grown;
  float slender = 0.85 + 0.35 * fract(traits.z * 7.31);
  mat2 turn = mat2(traits.x, traits.y, -traits.y, traits.x);
  vec3 at = vec3(turn * place.xy * slender, place.z - 0.02) * size;
  float gust = sin(time * 1.3 + dot(stand.xy, vec2(0.21, 0.17))) + 0.5 * sin(time * 2.9 + stand.x);
  at.xy += sway * gust * place.z * place.z * vec2(0.8, 0.5);
  from = foot + at;
  facing = vec3(turn * normal.xy, normal.z);
  float warm = fract(traits.z * 13.7) - 0.5;
  tone = color * (0.86 + 0.3 * traits.z);
  if (kind != 2.0) tone *= vec3(1.0 + 0.3 * warm, 1.0 + 0.02 * warm, 1.0 - 0.2 * warm);
  tone *= tone * 2.2;
  gl_Position = grown > 0.0 ? view * vec4(from, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}`, `#version 300 es
precision highp float;
in vec3 from, facing, tone;
out vec4 result;
${AIR}${LIGHT}
void main() {
  vec3 normal = normalize(facing);
  vec3 color = lit(tone, normal, 1.0);
  // Leaves let some light through from behind.
  color += tone * daylight * 0.22 * pow(max(dot(normalize(from), sun), 0.0), 3.0);
  result = shown(hazed(color, from));
}`];

export const SHADOWS = [`#version 300 es
layout(location = 3) in vec4 stand;
layout(location = 4) in vec4 traits;
layout(location = 5) in vec2 slope;
const vec2 CORNERS[4] = vec2[4](vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0), vec2(1.0, 1.0));
uniform vec3 sun;
uniform float wide, tall;
out vec2 at;
out float away;
${GROWN}
void main() {
  at = CORNERS[gl_VertexID];
  vec3 foot = corner + stand.xyz;
  away = length(foot.xy);
  float grown = grownAt(foot.xy, traits.w);
  vec2 along = -normalize(sun.xy);
  float size = stand.w * grown;
  float length_of = size * min(tall / max(sun.z, 0.25), 1.5);
  vec2 spread = along * (at.y * 0.5 + 0.42) * length_of + vec2(-along.y, along.x) * at.x * wide * size;
  vec3 place = foot + vec3(spread, dot(slope, spread) + 0.06);
  gl_Position = grown > 0.0 ? view * vec4(place, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}`, `#version 300 es
precision highp float;
in vec2 at;
in float away;
uniform float dark;
out vec4 result;
void main() {
  float soft = smoothstep(1.0, 0.35, length(at));
  result = vec4(0.0, 0.01, 0.02, dark * soft * exp(-away * 0.006));
}`];
