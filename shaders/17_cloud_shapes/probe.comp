// Optical depth of all clouds along the rays of --probe.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define CLOUD_BINDING 0
#include "17_cloud_shapes/block.glsl"

struct Ray {
  vec4 origin;     // w: altitude
  vec4 rest;       // w: cosine to the vertical
  vec4 direction;  // w: sine
  vec4 end;        // x: distance to the ground
};
layout(binding = 6, std430) readonly buffer Rays {
  Ray rays[];
};
layout(binding = 7, std430) writeonly buffer Results {
  float results[];
};
layout(push_constant) uniform Push {
  int steps, detail, grid_method, grid_steps;
  int count;
};

void main() {
  if (gl_GlobalInvocationID.x >= uint(count)) return;
  const Ray from = rays[gl_GlobalInvocationID.x];
  const CloudRay ray = CloudRay(from.origin.xyz, from.rest.xyz, from.direction.xyz, from.origin.w, from.rest.w, from.direction.w, 0.0, from.end.x);
  results[gl_GlobalInvocationID.x] = cloud_optical_depth(ray, CloudMarch(steps, detail, grid_method, grid_steps, 0.5));
}
