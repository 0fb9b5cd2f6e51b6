// The arithmetic of double_float.glsl over pairs. Item: a.hi, a.lo, b.hi, b.lo (b not 0). Result: two_sum and
// two_product of the high parts, sum, product, quotient, root of |a|, each as (hi, lo); then a b - fl(a b) by fma().
#version 460
#extension GL_GOOGLE_include_directive : require
#include "03_planet_and_rays/double_float.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer Inputs { float inputs[]; };
layout(binding = 1) writeonly buffer Outputs { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const vec2 a = vec2(inputs[4 * item], inputs[4 * item + 1]);
  const vec2 b = vec2(inputs[4 * item + 2], inputs[4 * item + 3]);
  const vec2 results[6] = vec2[](two_sum(a.x, b.x), two_product(a.x, b.x), df_add(a, b), df_multiply(a, b),
                                 df_divide(a, b), df_sqrt(a.x < 0.0 ? df_negate(a) : a));
  for (int i = 0; i < 6; ++i) {
    outputs[13 * item + 2 * i] = results[i].x;
    outputs[13 * item + 2 * i + 1] = results[i].y;
  }
  precise float p = a.x * b.x;
  precise float e = fma(a.x, b.x, -p);
  outputs[13 * item + 12] = e;
}
