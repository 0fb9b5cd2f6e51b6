// Computes the nodes of all rays that light is gathered along: one panel of one ray per invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }
#include "09_multiple_scattering_lut/variant.glsl"
#define NODES_ARE_WRITTEN
#include "09_multiple_scattering_lut/gather_block.glsl"

layout(local_size_x = 32) in;

// [nodes]
void main() {
  const int panels = STEPS / 4, zenith_angles = zenith_angles_of_set(DIRECTION_SET, DIRECTIONS);
  const int ray = int(gl_GlobalInvocationID.x) / panels, panel = int(gl_GlobalInvocationID.x) % panels;
  const int row = ray / zenith_angles;
  if (row >= MS_SIZE) return;
  const Atmosphere air = method_air(atmosphere, MS_METHOD).air;
  const float altitude_km = texel_point(ivec2(0, row)).y;
  const WeightedDirection direction = direction_of_set(DIRECTION_SET, ray % zenith_angles, DIRECTIONS,
                                                       horizon_cosine(air.ground_radius_km, altitude_km));
  const SourceRay along = source_ray(air, enter_air(air, altitude_km, direction.view, vec3(0.0, 0.0, 1.0)));
  const NodePanel placed = panel_nodes(air, along, panel, panels);
  for (int i = 0; i < 4; ++i) nodes[ray * (STEPS + 1) + 4 * panel + i] = placed.node[i];
  if (panel == 0) nodes[ray * (STEPS + 1) + STEPS] = ray_end(air, along);
}
// [/nodes]
