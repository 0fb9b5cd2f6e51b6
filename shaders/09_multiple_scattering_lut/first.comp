// The table's first order: light scattered once, or returned by the ground, arriving at each texel's point.
#version 460
#extension GL_GOOGLE_include_directive : require
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }  // there is none yet
#include "09_multiple_scattering_lut/variant.glsl"
#include "09_multiple_scattering_lut/reduce.glsl"

layout(binding = 1, rgba32f) uniform writeonly image2D orders;

void main() {
  const ivec2 texel = ivec2(gl_WorkGroupID.xy);
  const uint thread = gl_LocalInvocationID.x;
  const vec2 point = texel_point(texel);
  const Atmosphere air = atmosphere;
  const MethodAir method = method_air(air, MS_METHOD);
  for (int layer = 0; layer < kLayers; ++layer) partial[layer][thread] = vec3(0.0);
  for (int n = int(thread); n < DIRECTIONS; n += 64) {
    const WeightedDirection direction = direction_of_set(DIRECTION_SET, n, DIRECTIONS, horizon_cosine(air.shape.x, point.y));
    add_direction(direction, first_order(method, point.y, direction.look, sun_at(point.x), STEPS));
  }
  sum_over_threads(kLayers);
  if (thread == 0) {
    const vec3 mean = max(partial[0][0], vec3(kLeastMean));
    imageStore(orders, texel, vec4(encode_mean(mean), 0.0));
    for (int layer = 1; layer < kLayers; ++layer) imageStore(orders, texel + ivec2(0, layer * MS_SIZE), vec4(partial[layer][0] / mean, 0.0));
  }
}
