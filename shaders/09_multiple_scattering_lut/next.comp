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
  const int thread = int(gl_LocalInvocationID.x);
  const vec2 point = texel_point(texel);
  const vec3 sun = sun_at(point.x);
  const MethodAir method = method_air(atmosphere, MS_METHOD);
  clear_sums();
  for (int item = thread; item < DIRECTIONS * PARTS; item += THREADS) {
    const int n = item % DIRECTIONS, part = item / DIRECTIONS, ray = first_node_of(texel.y, n);
    const WeightedDirection direction = direction_of_set(DIRECTION_SET, n, DIRECTIONS, horizon_cosine(method.air.ground_radius_km, point.y));
    const float nu = dot(direction.look, sun);
    vec3 light = part == 0 ? table_at_end(method.air, nodes[ray + STEPS], point.x, nu) : vec3(0.0);
    for (int i = part * STEPS / PARTS; i < (part + 1) * STEPS / PARTS; ++i)
      light += table_at_node(method.air, nodes[ray + i], method.chi, direction.look.z, point.x, nu);
    add_direction(direction, light);
  }
  sum_over_threads(kLayers);
  const vec3 first_mean = decode_mean(imageLoad(first, texel).rgb);
  const vec3 mean = max(sum_of(0) + first_mean, vec3(kLeastMean));
  for (int layer = thread; layer < kLayers; layer += THREADS) {
    const ivec2 place = texel + ivec2(0, layer * MS_SIZE);
    const vec3 moment = (sum_of(layer) + first_mean * imageLoad(first, place).rgb) / mean;
    imageStore(orders, place, vec4(layer == 0 ? encode_mean(mean) : moment, 0.0));
  }
}
// [/next]
