// Looks paths up in a transmittance table: reads (altitude, mu), writes transmittance_to_top() and
// optical_depth_to_top().
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "04_air/variant.glsl"
#define TRANSMITTANCE_BINDING 1
#include "08_transmittance_lut/table.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
layout(binding = 2, std430) readonly buffer Inputs {
  vec4 paths[];
};
layout(binding = 3, std430) writeonly buffer Outputs {
  vec4 results[];  // two per path
};
layout(push_constant) uniform Push {
  uint count;
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  results[2 * i] = vec4(transmittance_to_top(atmosphere, paths[i].x, paths[i].y), 0.0);
  results[2 * i + 1] = vec4(optical_depth_to_top(atmosphere, paths[i].x, paths[i].y), 0.0);
}
