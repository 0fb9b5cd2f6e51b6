// Cellular noise: every cell of a lattice holds one random point. Unit: one cell; it repeats after `period` cells.
//
// Worley's (Worley 1996) is the distance to the nearest point. Here it is inverted and squared: 1 - d^2 is a round dome on
// every point, as the tops of a cauliflower are, where 1 - d is a cone with a tip. It also needs no square root, which
// Vulkan lets a device round as it likes.
//
// Alligator noise (the name is that of the modelling program it comes from): every point is a soft ball of its own strength,
// and the noise is by how much the strongest ball at a place exceeds the second. Where two are equal it is 0: creases, as
// in a reptile's skin, round bodies of voxels.
#ifndef WELKIN_NOISE_WORLEY_GLSL
#define WELKIN_NOISE_WORLEY_GLSL

#include "16_noise/hash.glsl"

// [worley]
// Square of the distance from p to the nearest point, at most 1. A point nearer than 1 lies in this cell or in one of the 26
// around it. In a place without one the domes have ended, and it does not matter where the nearest is.
float nearest_squared(vec3 p, int period, uint seed) {
  vec3 corner = floor(p);
  vec3 d = p - corner;
  ivec3 cell = ivec3(corner);
  float nearest = 1.0;
  for (int k = -1; k <= 1; k++)
    for (int j = -1; j <= 1; j++)
      for (int i = -1; i <= 1; i++) {
        uvec4 random = hashed(wrapped(cell + ivec3(i, j, k), period), seed);
        precise vec3 to = vec3(unit_float(random.x), unit_float(random.y), unit_float(random.z)) + vec3(i, j, k) - d;
        precise float squared = to.x * to.x + to.y * to.y + to.z * to.z;
        nearest = min(nearest, squared);
      }
  return nearest;
}

// 0 ... 1: 1 on every point, 0 where none is within a cell's width.
float inverted_worley(vec3 p, int period, uint seed) { return 1.0 - nearest_squared(p, period, seed); }
// [/worley]

float inverted_worley(vec2 p, int period, uint seed) {
  vec2 corner = floor(p);
  vec2 d = p - corner;
  ivec2 cell = ivec2(corner);
  float nearest = 1.0;
  for (int j = -1; j <= 1; j++)
    for (int i = -1; i <= 1; i++) {
      uvec4 random = hashed(ivec3(wrapped(cell + ivec2(i, j), period), 0), seed);
      precise vec2 to = vec2(unit_float(random.x), unit_float(random.y)) + vec2(i, j) - d;
      precise float squared = to.x * to.x + to.y * to.y;
      nearest = min(nearest, squared);
    }
  return 1.0 - nearest;
}

// [alligator]
float alligator(vec3 p, int period, uint seed) {
  vec3 corner = floor(p);
  vec3 d = p - corner;
  ivec3 cell = ivec3(corner);
  float strongest = 0.0;
  float second = 0.0;
  for (int k = -1; k <= 1; k++)
    for (int j = -1; j <= 1; j++)
      for (int i = -1; i <= 1; i++) {
        uvec4 random = hashed(wrapped(cell + ivec3(i, j, k), period), seed);
        precise vec3 to = vec3(unit_float(random.x), unit_float(random.y), unit_float(random.z)) + vec3(i, j, k) - d;
        precise float inside = max(1.0 - (to.x * to.x + to.y * to.y + to.z * to.z), 0.0);
        precise float ball = unit_float(random.w) * (inside * inside * (3.0 - 2.0 * inside));
        second = max(second, min(strongest, ball));
        strongest = max(strongest, ball);
      }
  return strongest - second;
}
// [/alligator]

#endif
