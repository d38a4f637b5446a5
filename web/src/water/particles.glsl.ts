// Shaders of the particles. `a`, `b`: a particle in two frames, as format.ts packs it.
export const vertex = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler2D;
in vec4 a;
in vec4 b;
in float own;
in float grain;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform float share, radius, larger, pixels, smallest, thickness;
uniform vec3 minA, sizeA, minB, sizeB;
uniform vec4 rangeA, rangeB, plane, up, levelGrid, tint;
uniform vec2 limits, levelOrigin;
uniform int quantity, upAxis;
uniform sampler2D map, levels;
flat out vec3 colour;
flat out float eyeDepth;
flat out float size;
flat out float sphere;

float scalar(float packed, vec4 range) {
  float both = floor(packed * 65535.0 + 0.5);
  float high = floor(both / 256.0);
  return quantity == 0 ? mix(range.x, range.y, (both - 256.0 * high) / 255.0) : mix(range.z, range.w, high / 255.0);
}

float depthBelowSurface(vec3 x) {
  vec2 flat_ = upAxis == 0 ? x.yz : upAxis == 1 ? x.xz : x.xy;
  ivec2 cell = clamp(ivec2((flat_ - levelOrigin) / levelGrid.z), ivec2(0), ivec2(levelGrid.xy) - 1);
  return max(0.0, texelFetch(levels, cell, 0).r - dot(x, up.xyz));
}

void main() {
  vec3 x = mix(minA + a.xyz * sizeA, minB + b.xyz * sizeB, share);
  #if DIM == 2
  x.z = 0.0;
  #endif
  float value = 0.0;
  if (quantity < 2) value = mix(scalar(a.w, rangeA), scalar(b.w, rangeB), share);
  else if (quantity == 2) value = depthBelowSurface(x);
  else if (quantity == 3) value = own;
  float t = clamp((value - limits.x) / max(limits.y - limits.x, 1e-20), 0.0, 1.0);
  colour = quantity == 4 ? tint.rgb : mix(texelFetch(map, ivec2(int(t * 255.0 + 0.5), 0), 0).rgb, tint.rgb, tint.a);
  vec4 eye = modelViewMatrix * vec4(x, 1.0);
  gl_Position = projectionMatrix * eye;
  eyeDepth = -eye.z;
  sphere = radius * larger * grain;
  size = max(smallest, 2.0 * sphere * pixels / (DIM == 2 ? 1.0 : max(-eye.z, 1e-6)));
  gl_PointSize = size;
  float side = dot(plane.xyz, x) + plane.w;
  if (side < 0.0 || side > thickness) gl_Position = vec4(0.0, 0.0, 2.0, 0.0);
}
`;

export const fragment = /* glsl */ `
precision mediump float;
uniform float opacity;
flat in vec3 colour;
flat in float eyeDepth;
flat in float size;
out vec4 pixel;

void main() {
  vec3 shade = colour;
  float cover = opacity;
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r2 = dot(p, p);
  #if DIM == 2
  if (size > 3.0) {
    cover *= clamp((1.0 - sqrt(r2)) * 0.5 * size + 0.5, 0.0, 1.0);
    if (cover <= 0.0) discard;
    shade *= 1.0 - 0.16 * r2 * r2;
  }
  #else
  if (r2 > 1.0) discard;
  float nz = sqrt(1.0 - r2);
  float light = 0.42 + 0.58 * max(0.0, 0.35 * p.x * 0.6 - 0.55 * p.y + 0.76 * nz);
  float glance = max(0.0, nz * 0.9 - 0.35 * p.y);
  float third = glance * glance * glance;
  shade = colour * light + 0.12 * third * third * third * third;
  #endif
  pixel = vec4(shade, cover);
}
`;
