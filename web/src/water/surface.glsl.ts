// Shaders of the surface. Depths are distances before the camera, m; 0 where there is no water.
export const full = /* glsl */ `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

/** A sphere's depth and colour. */
export const depth = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix;
flat in vec3 colour;
flat in float eyeDepth;
flat in float sphere;
layout(location = 0) out vec4 depths;
layout(location = 1) out vec4 colours;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r2 = dot(p, p);
  if (r2 > 1.0) discard;
  float d = eyeDepth - sphere * sqrt(1.0 - r2);
  float clip = (projectionMatrix[2][2] * -d + projectionMatrix[3][2]) / d;
  gl_FragDepth = 0.5 * clip + 0.5;
  depths = vec4(d, 0.0, 0.0, 1.0);
  colours = vec4(colour, 1.0);
}
`;

/** Smooths along one axis what belongs to the same piece of surface. */
export const smooth = /* glsl */ `
precision highp float;
precision highp sampler2D;
uniform sampler2D from;
uniform vec2 along;
uniform float pixels, spacing, reach;
out vec4 depths;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 size = textureSize(from, 0);
  float d = texelFetch(from, here, 0).r;
  if (d <= 0.0) { depths = vec4(0.0); return; }
  if (along.x == along.y) { // last, what rows and columns have left: both ways at once
    float sum = 0.0, weight = 0.0;
    for (int i = -3; i <= 3; ++i) for (int j = -3; j <= 3; ++j) {
      float e = texelFetch(from, clamp(here + ivec2(i, j), ivec2(0), size - 1), 0).r;
      float apart = (e - d) / (2.5 * spacing);
      float w = e <= 0.0 ? 0.0 : exp(-apart * apart - 0.15 * float(i * i + j * j));
      sum += w * e;
      weight += w;
    }
    depths = vec4(sum / weight, 0.0, 0.0, 1.0);
    return;
  }
  float wide = clamp(reach * spacing * pixels / d, 1.0, 32.0);
  int n = int(ceil(wide));
  int step_ = 1 + n / 17;
  float sum = d, weight = 1.0;
  for (int k = step_; k <= n; k += step_) {
    float g = float(k) / wide;
    float near_ = exp(-2.0 * g * g);
    for (int s = -1; s <= 1; s += 2) {
      ivec2 there = here + ivec2(along) * (k * s);
      if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) continue;
      float e = texelFetch(from, there, 0).r;
      if (e <= 0.0) continue;
      float apart = (e - d) / (2.5 * spacing);
      float w = near_ * exp(-apart * apart);
      sum += w * e;
      weight += w;
    }
  }
  depths = vec4(sum / weight, 0.0, 0.0, 1.0);
}
`;

/** Light on the smoothed surface. */
export const compose = /* glsl */ `
precision highp float;
precision highp sampler2D;
uniform sampler2D depths, colours;
uniform vec2 corner, ends, size, origin;
uniform vec3 up;
out vec4 pixel;

vec3 place(ivec2 at, float d) {
  vec2 ndc = 2.0 * (vec2(at) + 0.5) / size - 1.0;
  return vec3(ndc * corner * d, -d);
}

float depthAt(ivec2 at) { return texelFetch(depths, clamp(at, ivec2(0), ivec2(size) - 1), 0).r; }

/** The smaller of the differences to both sides: the other one may lie across an edge. */
vec3 slope(ivec2 here, ivec2 by, vec3 p) {
  float ahead = depthAt(here + by), behind = depthAt(here - by);
  vec3 a = place(here + by, ahead) - p, b = p - place(here - by, behind);
  if (ahead <= 0.0) return b;
  if (behind <= 0.0) return a;
  return abs(a.z) < abs(b.z) ? a : b;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy - origin);
  float d = depthAt(here);
  if (d <= 0.0) discard;
  vec3 p = place(here, d);
  vec3 n = normalize(cross(slope(here, ivec2(1, 0), p), slope(here, ivec2(0, 1), p)));
  vec3 eye = normalize(-p);
  vec3 sun = normalize(vec3(0.35, 0.35, 0.6) + up);
  vec3 base = vec3(0.0);
  float weight = 0.0;
  for (int i = -2; i <= 2; ++i) for (int j = -2; j <= 2; ++j) {
    vec4 c = texelFetch(colours, clamp(here + 2 * ivec2(i, j), ivec2(0), ivec2(size) - 1), 0);
    base += c.rgb * c.a;
    weight += c.a;
  }
  base /= max(weight, 1e-6);
  float facing = max(dot(n, eye), 0.0);
  float sky = 0.5 + 0.5 * dot(n, up);
  float fresnel = 0.03 + 0.5 * pow(1.0 - facing, 4.0);
  float glint = pow(max(dot(n, normalize(sun + eye)), 0.0), 60.0);
  vec3 lit = base * (0.5 + 0.3 * sky + 0.3 * max(dot(n, sun), 0.0));
  pixel = vec4(mix(lit, vec3(0.80, 0.90, 0.97), fresnel * sky) + 0.35 * glint, 1.0);
  float n_ = ends.x, f = ends.y;
  gl_FragDepth = (f * (d - n_)) / (d * (f - n_));
}
`;
