// Traces the rays of --probe with all_orders_light(), which also draws the picture, without the sun's disc.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(binding = 1) uniform sampler2D table;
vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(table, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"

struct Ray {
  vec4 view;  // xyz: unit, in the local frame of the ray's first point; w: its altitude in km
  vec4 sun;   // xyz: unit vector to the sun, same frame
};
layout(binding = 2, std430) readonly buffer Rays {
  Ray rays[];
};
layout(binding = 3, std430) writeonly buffer Results {
  vec4 results[];  // two per ray: radiance, transmittance
};
layout(push_constant) uniform Push {
  ivec4 steps;  // x: first order, y: table, z: number of rays
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(steps.z)) return;
  const RayLight light =
      all_orders_light(atmosphere, rays[i].view.w, rays[i].view.xyz, rays[i].sun.xyz, steps.x, steps.y, true);
  results[2 * i] = vec4(light.radiance, 0.0);
  results[2 * i + 1] = vec4(light.transmittance, 0.0);
}
