// Harness: every phase function at one input. In: one_minus_nu, g, second_g, second_weight, alpha, diameter_um.
// Out: rayleigh, anisotropic (rho 0.035), henyey_greenstein, cornette_shanks, draine, double_hg, droplet, and the naive
// Henyey-Greenstein at nu = 1 - one_minus_nu.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/phase.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer In { float values[]; } inputs;
layout(binding = 1) writeonly buffer Out { float values[]; } outputs;
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uint a = 6u * i, b = 8u * i;
  const float x = inputs.values[a], g = inputs.values[a + 1u], second_g = inputs.values[a + 2u];
  const float weight = inputs.values[a + 3u], alpha = inputs.values[a + 4u], diameter = inputs.values[a + 5u];
  outputs.values[b] = rayleigh_phase(x);
  outputs.values[b + 1u] = rayleigh_anisotropic_phase(x, 0.035);
  outputs.values[b + 2u] = henyey_greenstein_phase(x, g);
  outputs.values[b + 3u] = cornette_shanks_phase(x, g);
  outputs.values[b + 4u] = draine_phase(x, g, alpha);
  outputs.values[b + 5u] = double_hg_phase(x, 2.0 - x, g, second_g, weight);
  outputs.values[b + 6u] = droplet_phase(x, diameter);
  outputs.values[b + 7u] = henyey_greenstein_phase_naive(1.0 - x, g);
}
