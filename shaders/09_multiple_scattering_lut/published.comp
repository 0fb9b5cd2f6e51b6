// The published table: Psi = L2 / (1 - f), one layer.
#version 460
#extension GL_GOOGLE_include_directive : require
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }
#include "09_multiple_scattering_lut/variant.glsl"
#include "09_multiple_scattering_lut/reduce.glsl"

layout(binding = 1, rgba32f) uniform writeonly image2D orders;

// [published]
void main() {
  const ivec2 texel = ivec2(gl_WorkGroupID.xy);
  const uint thread = gl_LocalInvocationID.x;
  const vec2 point = texel_point(texel);
  const Atmosphere air = atmosphere;
  partial[0][thread] = vec3(0.0);
  partial[1][thread] = vec3(0.0);
  for (int n = int(thread); n < DIRECTIONS; n += 64) {
    const WeightedDirection direction = direction_of_set(DIRECTION_SET, n, DIRECTIONS, horizon_cosine(air.shape.x, point.y));
    const Transfer light = published_transfer(air, point.y, direction.look, sun_at(point.x), STEPS);
    partial[0][thread] += light.second * direction.weight;
    partial[1][thread] += light.transfer * direction.weight;
  }
  sum_over_threads(2);
  if (thread == 0) imageStore(orders, texel, vec4(encode_mean(close_series(partial[0][0], partial[1][0])), 0.0));
}
// [/published]
