// The picture's shaders: one lights every texel of the bake, one shows them on the canvas. The model is the very text
// that `hemibake export --to glsl` writes.

export const kVertexShader = `#version 300 es
in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
`;

// Lit texels, placed and scaled.
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

// Four planes a layer: α, E₀, E₁, E₂; E₃, … Integers, so that a texel is what the bake says and nothing between two.
export function lightShader(model: string): string {
  return `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2DArray;
uniform usampler2DArray planes;
uniform float ao_step;
uniform float irradiance_step;  // of E/pi
uniform int layers;
uniform int last_bounce;
uniform vec3 albedo;
uniform float gain;
uniform int view;               // kViews in viewer.ts
uniform int as_color;           // 1: albedo times irradiance
uniform vec2 dividers;          // texels
uniform float range;            // largest difference shown
out vec4 color;

${model}

vec3 add_bounce(vec3 sum, uint code, int bounce) {
  return sum * albedo + (bounce <= last_bounce ? float(code) : 0.0);
}

vec3 traced_light(ivec2 texel) {
  vec3 sum = vec3(0.0);
  for (int layer = layers - 1; layer >= 0; --layer) {
    uvec4 codes = texelFetch(planes, ivec3(texel, layer), 0);
    int bounce = 4 * layer - 1;
    sum = add_bounce(sum, codes.w, bounce + 3);
    sum = add_bounce(sum, codes.z, bounce + 2);
    sum = add_bounce(sum, codes.y, bounce + 1);
    if (layer > 0) sum = add_bounce(sum, codes.x, bounce);
  }
  return sum * irradiance_step;
}

vec3 one_bounce(ivec2 texel) {
  int plane = last_bounce + 1;
  uvec4 codes = texelFetch(planes, ivec3(texel, plane / 4), 0);
  int part = plane % 4;
  uint code = part == 0 ? codes.x : part == 1 ? codes.y : part == 2 ? codes.z : codes.w;
  return pow(albedo, vec3(float(last_bounce))) * float(code) * irradiance_step;
}

vec3 encode(vec3 light) {
  vec3 x = clamp(light * gain, 0.0, 1.0);
  return mix(x * 12.92, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x));
}

vec3 signed_color(float difference) {
  float x = clamp(difference / range, -1.0, 1.0);
  vec3 end = x < 0.0 ? vec3(0.13, 0.40, 0.67) : vec3(0.70, 0.09, 0.17);
  return mix(vec3(0.97), end, pow(abs(x), 0.8));
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float ao = float(texelFetch(planes, ivec3(texel, 0), 0).x) * ao_step;
  vec3 shown = as_color == 1 ? albedo : vec3(1.0);
  int what = view;
  if (view == 0) what = gl_FragCoord.x < dividers.x ? 1 : gl_FragCoord.x < dividers.y ? 2 : 3;
  if (what == 1) color = vec4(encode(shown * ao), 1.0);
  else if (what == 2) color = vec4(encode(shown * multi_bounce_irradiance(ao, albedo)), 1.0);
  else if (what == 3) color = vec4(encode(shown * traced_light(texel)), 1.0);
  else if (what == 4) color = vec4(encode(shown * one_bounce(texel)), 1.0);
  else {
    vec3 light = what == 5 ? multi_bounce_irradiance(ao, albedo) : vec3(ao);
    vec3 difference = shown * (light - traced_light(texel));
    color = vec4(signed_color(dot(difference, vec3(0.2126, 0.7152, 0.0722))), 1.0);
  }
}
`;
}
