// Perlin's gradient noise (Perlin 2002) in 2-D and 3-D, with its derivatives. Unit: one cell of the lattice; it repeats
// after `period` cells, a power of two. At every corner a gradient is drawn; the corner's plane g . (p - corner) is blended with the others'
// by the quintic 6 t^5 - 15 t^4 + 10 t^3, whose first two derivatives vanish at the corners.
//
// `precise` forbids the compiler to fuse a product and a sum: a fused one rounds once instead of twice, and the last bit
// would depend on the device.
#ifndef WELKIN_NOISE_PERLIN_GLSL
#define WELKIN_NOISE_PERLIN_GLSL

#include "16_noise/hash.glsl"

float fade(float t) {
  precise float value = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
  return value;
}
float fade_slope(float t) {
  precise float slope = 30.0 * t * t * (t * (t - 2.0) + 1.0);
  return slope;
}

float blend(float a, float b, float t) {
  precise float value = a + t * (b - a);
  return value;
}

// Of the highest bit: products mix upwards, and the low bits of neighbouring cells are a little alike.
float sign_of(uint bits) { return (bits & 0x80000000u) == 0u ? 1.0 : -1.0; }

// [perlin]
// One of the twelve midpoints of a cube's edges, each as likely: an axis has no part in it, the others have a sign.
vec3 gradient(ivec3 corner, int period, uint seed) {
  uvec4 random = hashed(wrapped(corner, period), seed);
  float first = sign_of(random.x);
  float second = sign_of(random.y);
  uint without = ((random.z >> 16u) * 3u) >> 16u;
  if (without == 0u) return vec3(0.0, first, second);
  return without == 1u ? vec3(first, 0.0, second) : vec3(first, second, 0.0);
}

// What the corner says at offset d from it: its plane's height and slope.
vec4 plane(vec3 g, vec3 d) {
  precise float height = g.x * d.x + g.y * d.y + g.z * d.z;
  return vec4(height, g);
}

// Both ends of an edge blended: also how fast the blend itself changes along the edge, into `axis` of the slope.
vec4 blended(vec4 a, vec4 b, float t, int axis) {
  float s = fade(t);
  vec4 value = vec4(blend(a.x, b.x, s), blend(a.y, b.y, s), blend(a.z, b.z, s), blend(a.w, b.w, s));
  precise float along = value[axis] + fade_slope(t) * (b.x - a.x);
  value[axis] = along;
  return value;
}

// (noise, d/dx, d/dy, d/dz); the noise is within -1 ... 1, and 0 at every corner.
vec4 perlin(vec3 p, int period, uint seed) {
  vec3 corner = floor(p);
  vec3 d = p - corner;
  ivec3 cell = ivec3(corner);
  vec4 on_z[2];
  for (int k = 0; k < 2; k++) {
    vec4 on_y[2];
    for (int j = 0; j < 2; j++) {
      vec4 left = plane(gradient(cell + ivec3(0, j, k), period, seed), d - vec3(0.0, float(j), float(k)));
      vec4 right = plane(gradient(cell + ivec3(1, j, k), period, seed), d - vec3(1.0, float(j), float(k)));
      on_y[j] = blended(left, right, d.x, 1);
    }
    on_z[k] = blended(on_y[0], on_y[1], d.y, 2);
  }
  return blended(on_z[0], on_z[1], d.z, 3);
}
// [/perlin]

// 2-D: eight directions of one length. (noise, d/dx, d/dy), within -1 ... 1.
vec2 gradient(ivec2 corner, int period, uint seed) {
  uvec4 random = hashed(ivec3(wrapped(corner, period), 0), seed);
  float first = sign_of(random.x);
  float second = sign_of(random.y);
  float along = second < 0.0 ? 1.41421356 : 0.0;
  return sign_of(random.z) > 0.0 ? vec2(first, second) : first * vec2(along, 1.41421356 - along);
}

vec4 plane(vec2 g, vec2 d) {
  precise float height = g.x * d.x + g.y * d.y;
  return vec4(height, g, 0.0);
}

vec3 perlin(vec2 p, int period, uint seed) {
  vec2 corner = floor(p);
  vec2 d = p - corner;
  ivec2 cell = ivec2(corner);
  vec4 on_y[2];
  for (int j = 0; j < 2; j++) {
    vec4 left = plane(gradient(cell + ivec2(0, j), period, seed), d - vec2(0.0, float(j)));
    vec4 right = plane(gradient(cell + ivec2(1, j), period, seed), d - vec2(1.0, float(j)));
    on_y[j] = blended(left, right, d.x, 1);
  }
  return blended(on_y[0], on_y[1], d.y, 2).xyz;
}

#endif
