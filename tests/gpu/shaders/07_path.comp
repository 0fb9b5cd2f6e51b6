// Means over random paths, for rays each with an atmosphere of its own. Reads 40 floats an item: the seven vec4 of
// Atmosphere, view (w: altitude, km), sun, (paths, stream, orders, distance to a surface); writes the sum of radiance, its sum of squares,
// how many paths were not finished, and the longest path's vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool HAS_RAYLEIGH = true;
layout(constant_id = 1) const bool HAS_MIE = true;
layout(constant_id = 2) const bool HAS_OZONE = true;
layout(constant_id = 3) const int MIE_PHASE = 1;
layout(constant_id = 4) const int TRACKING = 3;
layout(constant_id = 5) const bool HERO = true;
layout(constant_id = 6) const bool ENVIRONMENT = false;
layout(constant_id = 7) const bool SPREAD = true;
layout(constant_id = 8) const bool SURFACES = false;
#include "07_ground_truth/path.glsl"
#include "../tests/gpu/shaders/atmosphere_of.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  vec4 inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint first = 10 * item;
  const Atmosphere atmosphere = atmosphere_of(inputs[first], inputs[first + 1], inputs[first + 2], inputs[first + 3],
                                           inputs[first + 4], inputs[first + 5], inputs[first + 6]);
  const vec4 view = inputs[first + 7];
  const vec4 sun = inputs[first + 8];
  const vec4 setting = inputs[first + 9];
  // With surfaces: distance in setting.w, level, of the ground's albedo.
  const FirstSurface surface = FirstSurface(SURFACES ? setting.w : 0.0, vec3(0.0, 0.0, 1.0), atmosphere.ground_albedo);
  vec3 sum = vec3(0.0), squares = vec3(0.0);
  float unfinished = 0.0;
  int longest = 0;
  for (int i = 0; i < int(setting.x); ++i) {
    const PathLight light = trace_path(atmosphere, view.w, view.xyz, sun.xyz, surface, int(setting.z), random_stream(item, uint(i), uint(setting.y)));
    sum += light.radiance;
    squares += light.radiance * light.radiance;
    if (!light.finished) unfinished += 1.0;
    longest = max(longest, light.vertices);
  }
  for (int c = 0; c < 3; ++c) {
    outputs[8 * item + c] = sum[c];
    outputs[8 * item + 3 + c] = squares[c];
  }
  outputs[8 * item + 6] = unfinished;
  outputs[8 * item + 7] = float(longest);
}
