// The rays of --probe through the same single_scattering() that draws the picture; never with the sun's disc.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "05_single_scattering/sky.glsl"

struct Ray {
  vec4 view;  // xyz: unit, in the local frame of the ray's first point; w: its altitude in km
  vec4 sun;   // xyz: unit vector to the sun, same frame
};
layout(binding = 1, std430) readonly buffer Rays {
  Ray rays[];
};
layout(binding = 2, std430) writeonly buffer Results {
  vec4 results[];  // two a ray: radiance, transmittance
};
layout(push_constant) uniform Push {
  ivec4 steps;  // x: view, y: number of rays
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(steps.y)) return;
  const RayLight light = single_scattering(atmosphere, rays[i].view.w, rays[i].view.xyz, rays[i].sun.xyz, steps.x,
                                           LIGHT_STEPS, RULE);
  results[2 * i] = vec4(light.radiance, 0.0);
  results[2 * i + 1] = vec4(light.transmittance, 0.0);
}
