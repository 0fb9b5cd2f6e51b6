// Sums of very many small numbers in float32. Pure functions.
//
// A float32 sum of equal terms stops growing near 2^24 of them, and is wrong long before. Here each sum is two floats,
// the second holding what the first could not (two_sum of chapter 03): good to 48 bits, so 10^9 samples are safe.
#ifndef WELKIN_ACCUMULATE_GLSL
#define WELKIN_ACCUMULATE_GLSL

#include "03_planet_and_rays/double_float.glsl"

// [accumulate]
// What a pixel keeps: sums over batches of their mean radiance, and of the square of its luminance, for the standard
// error.
struct Accumulated {
  vec4 sum;  // xyz: radiance, w: luminance^2
  vec4 low;  // what rounding left of each
};

// A running sum (x: value, y: its rest) and one more term.
vec2 add_to_sum(vec2 sum, float term) {
  vec2 added = two_sum(sum.x, term);
  return quick_two_sum(added.x, added.y + sum.y);
}

float luminance_of(vec3 radiance) { return dot(radiance, vec3(0.2126, 0.7152, 0.0722)); }

Accumulated accumulated(Accumulated before, vec3 radiance) {
  float luminance = luminance_of(radiance);
  vec2 r = add_to_sum(vec2(before.sum.x, before.low.x), radiance.x);
  vec2 g = add_to_sum(vec2(before.sum.y, before.low.y), radiance.y);
  vec2 b = add_to_sum(vec2(before.sum.z, before.low.z), radiance.z);
  vec2 square = add_to_sum(vec2(before.sum.w, before.low.w), luminance * luminance);
  Accumulated after;
  after.sum = vec4(r.x, g.x, b.x, square.x);
  after.low = vec4(r.y, g.y, b.y, square.y);
  return after;
}

// Mean of n batches, and one standard error of its luminance: from the spread of the batches, 0 for fewer than two.
vec3 mean_radiance(Accumulated total, float batches) { return (vec3(total.sum) + vec3(total.low)) / batches; }

float standard_error(Accumulated total, float batches) {
  if (batches < 2.0) return 0.0;
  float mean = luminance_of(mean_radiance(total, batches));
  float square = (total.sum.w + total.low.w) / batches;
  return sqrt(max(square - mean * mean, 0.0) / (batches - 1.0));
}
// [/accumulate]

#endif
