// One more order: the light in the table so far is scattered once more towards each texel's point, and the first order is
// added. After n times the table holds the orders up to n + 1.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(binding = 1) uniform sampler2D before;
vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(before, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"
#include "09_multiple_scattering_lut/reduce.glsl"

layout(binding = 2, rgba32f) uniform readonly image2D first;
layout(binding = 3, rgba32f) uniform writeonly image2D orders;

// [next]
void main() {
  const ivec2 texel = ivec2(gl_WorkGroupID.xy);
  const uint thread = gl_LocalInvocationID.x;
  const vec2 point = texel_point(texel);
  const Atmosphere air = atmosphere;
  const MethodAir method = method_air(air, MS_METHOD);
  for (int layer = 0; layer < kLayers; ++layer) partial[layer][thread] = vec3(0.0);
  for (int n = int(thread); n < DIRECTIONS; n += 64) {
    const WeightedDirection direction = direction_of_set(DIRECTION_SET, n, DIRECTIONS, horizon_cosine(air.shape.x, point.y));
    add_direction(direction, next_order(method, point.y, direction.look, sun_at(point.x), STEPS));
  }
  sum_over_threads(kLayers);
  if (thread == 0) {
    const vec3 first_mean = decode_mean(imageLoad(first, texel).rgb);
    const vec3 mean = max(partial[0][0] + first_mean, vec3(kLeastMean));
    imageStore(orders, texel, vec4(encode_mean(mean), 0.0));
    for (int layer = 1; layer < kLayers; ++layer) {
      const ivec2 place = texel + ivec2(0, layer * MS_SIZE);
      imageStore(orders, place, vec4((partial[layer][0] + first_mean * imageLoad(first, place).rgb) / mean, 0.0));
    }
  }
}
// [/next]
