// The rays of --probe: a few paths of one ray per invocation, so that a single ray, too, keeps a device busy.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "07_ground_truth/sky_paths.glsl"

struct Ray {
  vec4 view;  // xyz: unit, in the local frame of the ray's first point; w: its altitude in km
  vec4 sun;   // xyz: unit vector to the sun, same frame
};
layout(binding = 1, std430) readonly buffer Rays {
  Ray rays[];
};
layout(binding = 2, std430) writeonly buffer Results {
  vec4 results[];  // three an invocation: sum of radiance (w: paths not finished), sum of its squares, transmittance
};
layout(push_constant) uniform Push {
  ivec4 work;   // x: first ray, y: blocks per ray, z: samples per block, w: invocations
  ivec4 extra;  // x: orders, y: seed, z: first block
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(work.w)) return;
  const uint ray = uint(work.x) + i / uint(work.y);
  const uint block = uint(extra.z) + i % uint(work.y);
  const Atmosphere air = atmosphere;
  const Ray probed = rays[ray];
  vec3 sum = vec3(0.0), squares = vec3(0.0);
  float cut = 0.0;
  for (int k = 0; k < work.z; ++k) {
    const Random random = random_stream(ray, block * uint(work.z) + uint(k), uint(extra.y));
    const PathLight light =
        trace_path(air, probed.view.w, probed.view.xyz, probed.sun.xyz, no_surface(), extra.x, random);
    sum += light.radiance;
    squares += light.radiance * light.radiance;
    if (!light.finished) cut += 1.0;
  }
  results[3 * i] = vec4(sum, cut);
  results[3 * i + 1] = vec4(squares, 0.0);
  vec3 transmittance = vec3(1.0);
  const AirRay clipped = enter_air(air, probed.view.w, probed.view.xyz, probed.sun.xyz);
  if (clipped.hits_air) transmittance = exp(-extinction(air, ray_columns(air, clipped)));
  results[3 * i + 2] = vec4(transmittance, 0.0);
}
