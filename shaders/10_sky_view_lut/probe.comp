// Looks up rays of --probe that share an altitude and a sun zenith angle, in the table filled for both.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "04_air/variant.glsl"
#include "05_single_scattering/single_scattering.glsl"
layout(constant_id = 4) const float SKY_VIEW_UNIT = 1.0;
#define SKY_VIEW_BINDING 1
#include "10_sky_view_lut/sky_view.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};

struct Ray {
  vec4 view;  // xyz: unit, local frame; w: altitude in km
  vec4 sun;
};
layout(binding = 2, std430) readonly buffer Rays {
  Ray rays[];
};
layout(binding = 3, std430) writeonly buffer Results {
  vec4 results[];  // two per ray: radiance, transmittance
};
layout(push_constant) uniform Push {
  ivec4 range;  // x: first ray, y: number of rays
};

void main() {
  if (gl_GlobalInvocationID.x >= uint(range.y)) return;
  const uint i = uint(range.x) + gl_GlobalInvocationID.x;
  const Atmosphere air = atmosphere;
  const vec3 view = rays[i].view.xyz;
  const vec3 sun = rays[i].sun.xyz;
  results[2 * i] = vec4(sky_view_radiance(air.ground_radius_km, rays[i].view.w, view, sun), 0.0);
  results[2 * i + 1] = vec4(single_scattering(air, rays[i].view.w, view, sun, 8, 1, kRuleAdapted).transmittance, 0.0);
}
