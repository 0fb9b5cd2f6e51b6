// Writes the table's first order: light scattered once, or reflected by the ground, that arrives at each texel's point.
#version 460
#extension GL_GOOGLE_include_directive : require
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }  // not filled yet
#include "09_multiple_scattering_lut/variant.glsl"
#include "09_multiple_scattering_lut/reduce.glsl"

layout(binding = 1, rgba32f) uniform writeonly image2D orders;

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
    const vec2 phases = first_order_phases(method.chi, nu);
    vec3 light = part == 0 ? sunlight_reflected_at_end(method.air, nodes[first_node + STEPS], point.x, nu) : vec3(0.0);
    for (int i = part * STEPS / PARTS; i < (part + 1) * STEPS / PARTS; ++i)
      light += sunlight_scattered_at_node(method.air, nodes[first_node + i], phases, point.x, nu);
    add_direction(direction, light);
  }
  sum_over_threads(kLayers);
  const vec3 mean = max(sum_of(0), vec3(kMinMean));
  for (int layer = thread; layer < kLayers; layer += THREADS)
    imageStore(orders, texel + ivec2(0, layer * MS_SIZE),
               vec4(layer == 0 ? encode_mean(mean) : sum_of(layer) / mean, 0.0));
}
