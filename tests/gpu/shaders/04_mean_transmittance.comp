// Harness: mean of exp(-tau) between two optical depths. In: tau_a, tau_b. Out: mean_transmittance, and the printed
// (exp(-a) - exp(-b)) / (b - a).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/variant.glsl"
layout(constant_id = 4) const int PHASE_DETAIL = 3;
#include "04_air/constant_sky.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer In { float values[]; } inputs;
layout(binding = 1) writeonly buffer Out { float values[]; } outputs;
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const float a = inputs.values[2u * i], b = inputs.values[2u * i + 1u];
  outputs.values[2u * i] = mean_transmittance(vec3(a), vec3(b)).x;
  outputs.values[2u * i + 1u] = (exp(-a) - exp(-b)) / (b - a);
}
