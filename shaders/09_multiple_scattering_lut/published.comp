// Writes the published table (Hillaire 2020): Psi = L2 / (1 - f), one layer.
#version 460
#extension GL_GOOGLE_include_directive : require
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }
#include "09_multiple_scattering_lut/variant.glsl"
#include "09_multiple_scattering_lut/reduce.glsl"

layout(binding = 1, rgba32f) uniform writeonly image2D orders;

// [published]
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
    vec3 second = part == 0 ? sunlight_reflected_at_end(method.air, nodes[first_node + STEPS], point.x, nu) : vec3(0.0);
    vec3 transfer = vec3(0.0);
    for (int i = part * STEPS / PARTS; i < (part + 1) * STEPS / PARTS; ++i) {
      second += sunlight_scattered_at_node(method.air, nodes[first_node + i], phases, point.x, nu);
      transfer += transfer_at_node(nodes[first_node + i]);
    }
    add(0, second * direction.weight);
    add(1, transfer * direction.weight);
  }
  sum_over_threads(2);
  if (thread == 0) imageStore(orders, texel, vec4(encode_mean(sum_geometric_series(sum_of(0), sum_of(1))), 0.0));
}
// [/published]
