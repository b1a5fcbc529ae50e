// Writes the picture's shaders: one lights every texel of the bake, one shows them on the canvas. The model is the very
// text that `hemibake export --to glsl` writes.

import { kLuminance, kTooBright, kTooDark } from './color';
import type { ModelData, ModelId } from './data';
import type { Panel, PlainAo } from './picture';

export const kVertexShader = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
`;

// Places and scales lit texels.
export const kShowShader = `#version 300 es
precision highp float;
uniform sampler2D lit;
uniform float canvas_height;
uniform vec2 origin;            // texel at the canvas' upper left corner
uniform float texels_per_pixel;
out vec4 color;
void main() {
  vec2 pixel = vec2(gl_FragCoord.x, canvas_height - gl_FragCoord.y);
  ivec2 texel = ivec2(floor(origin + pixel * texels_per_pixel));
  bool outside = any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, textureSize(lit, 0)));
  color = outside ? vec4(0.0) : texelFetch(lit, texel, 0);
}
`;

// Calls of the models' shader texts with what they take.
const kCalls: Record<ModelId, string> = {
  'visibility-ao': 'multi_bounce_irradiance(visibility, ao, albedo)',
  visibility: 'multi_bounce_irradiance(visibility, albedo)',
  'bounce-map': 'multi_bounce(vec2(visibility, unit_value(texel, bounce_plane, bounce_step)), albedo)',
  bounded: 'multi_bounce_irradiance(ao, albedo)',
  published: 'multi_bounce_irradiance(ao, albedo)',
  notes: 'multi_bounce_irradiance(ao, albedo)',
};

// Returns a statement that sets `color` of a texel.
function statementOf(panel: Panel, model: string, plain: PlainAo): string {
  switch (panel) {
    case 'off':
      return `color = vec4(encode(shown * ${plain}), 1.0);`;
    case 'model':
    case 'bounce map':
      return `color = vec4(encode(shown * ${model}), 1.0);`;
    case 'truth':
      return 'color = vec4(encode(shown * traced_light(texel)), 1.0);';
    case 'bounce':
      return 'color = vec4(encode(shown * one_bounce(texel)), 1.0);';
    case 'difference':
      return `color = signed_color(shown * (${model} - traced_light(texel)));`;
    case 'difference off':
      return `color = signed_color(shown * (vec3(${plain}) - traced_light(texel)));`;
  }
}

// Eight planes a layer, two in each channel: α and E₀, E₁ and E₂, …, and behind the bounces the bounce map and V, where
// they are planes of their own. Integers, so that a texel is what the bake says and nothing between two.
// A shader for each panel: software renderers work through every branch.
export function lightShader(model: ModelData, panel: Panel, plain: PlainAo): string {
  return `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2DArray;
uniform usampler2DArray planes;
uniform float ao_step;
uniform float irradiance_step;  // of E/pi
uniform float visibility_step;
uniform int visibility_plane;
uniform float bounce_step;
uniform int bounce_plane;
uniform int last_bounce;
uniform vec3 albedo;
uniform vec3 shown;             // albedo for colour, 1 for light
uniform float gain;
uniform float range;            // largest difference shown
out vec4 color;

${model.shader.glsl}

// Two bounces, the first of them in the lower half; -1 is AO.
vec3 add_bounces(vec3 sum, uint codes, int bounce) {
  sum = sum * albedo + (bounce < last_bounce ? float(codes >> 16) : 0.0);
  return bounce < 0 ? sum : sum * albedo + (bounce <= last_bounce ? float(codes & 0xffffu) : 0.0);
}

// Begins with the layer that has the last bounce.
vec3 traced_light(ivec2 texel) {
  vec3 sum = vec3(0.0);
  for (int layer = (last_bounce + 1) / 8; layer >= 0; --layer) {
    uvec4 codes = texelFetch(planes, ivec3(texel, layer), 0);
    int bounce = 8 * layer - 1;
    sum = add_bounces(sum, codes.w, bounce + 6);
    sum = add_bounces(sum, codes.z, bounce + 4);
    sum = add_bounces(sum, codes.y, bounce + 2);
    sum = add_bounces(sum, codes.x, bounce);
  }
  return sum * irradiance_step;
}

float value(ivec2 texel, int plane, float plane_step) {
  uint codes = texelFetch(planes, ivec3(texel, plane / 8), 0)[plane / 2 % 4];
  return float(plane % 2 == 0 ? codes & 0xffffu : codes >> 16) * plane_step;
}

float unit_value(ivec2 texel, int plane, float plane_step) { return min(value(texel, plane, plane_step), 1.0); }

vec3 one_bounce(ivec2 texel) {
  vec3 power = vec3(1.0);
  for (int b = 0; b < last_bounce; ++b) power *= albedo;
  return power * value(texel, last_bounce + 1, irradiance_step);
}

vec3 encode(vec3 light) {
  vec3 x = clamp(light * gain, 0.0, 1.0);
  return mix(x * 12.92, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}

vec4 signed_color(vec3 difference) {
  float x = clamp(dot(difference, vec3(${kLuminance})) / range, -1.0, 1.0);
  vec3 end = x < 0.0 ? vec3(${kTooDark}) : vec3(${kTooBright});
  return vec4(mix(vec3(0.97), end, pow(abs(x), 0.8)), 1.0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float ao = unit_value(texel, 0, ao_step);
  float visibility = unit_value(texel, visibility_plane, visibility_step);
  ${statementOf(panel, kCalls[model.id], plain)}
}
`;
}
