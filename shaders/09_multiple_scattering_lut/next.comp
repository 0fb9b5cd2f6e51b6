// Gathers one more order: scatters the light of the table so far once more towards each texel's point and adds the
// first order. After n runs the table holds the orders up to n + 1.
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
  const vec3 sun = sun_direction_from(point.x);
  const MethodAir method = method_air(atmosphere, MS_METHOD);
  clear_sums();
  for (int item = thread; item < DIRECTIONS * PARTS; item += THREADS) {
    const int n = item % DIRECTIONS, part = item / DIRECTIONS, first_node = first_node_of(texel.y, n);
    const WeightedDirection direction =
        direction_of_set(DIRECTION_SET, n, DIRECTIONS, horizon_cosine(method.air.ground_radius_km, point.y));
    const float nu = dot(direction.view, sun);
    vec3 light =
        part == 0 ? table_light_reflected_at_end(method.air, nodes[first_node + STEPS], point.x, nu) : vec3(0.0);
    for (int i = part * STEPS / PARTS; i < (part + 1) * STEPS / PARTS; ++i)
      light += table_light_scattered_at_node(method.air, nodes[first_node + i], method.chi, direction.view.z, point.x,
                                             nu);
    add_direction(direction, light);
  }
  sum_over_threads(kLayers);
  const vec3 first_mean = decode_mean(imageLoad(first, texel).rgb);
  const vec3 mean = max(sum_of(0) + first_mean, vec3(kMinMean));
  for (int layer = thread; layer < kLayers; layer += THREADS) {
    const ivec2 layer_texel = texel + ivec2(0, layer * MS_SIZE);
    const vec3 moment = (sum_of(layer) + first_mean * imageLoad(first, layer_texel).rgb) / mean;
    imageStore(orders, layer_texel, vec4(layer == 0 ? encode_mean(mean) : moment, 0.0));
  }
}
// [/next]
