// Single functions of chapter 18 over arrays. Reads 12 floats an item: which function, then its arguments; writes 8 floats.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
const bool HAS_RAYLEIGH = false;
const bool HAS_MIE = false;
const bool HAS_OZONE = false;
const int MIE_PHASE = 0;
#include "18_cloud_light/cloud_optics.glsl"
#include "18_cloud_light/in_scatter.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  float inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

// 1 - g, alpha, 1 - g of the second lobe, its alpha, its weight.
CloudPhase phase_of(uint at) {
  return CloudPhase(PhaseLobe(inputs[at], inputs[at + 1]), PhaseLobe(inputs[at + 2], inputs[at + 3]), inputs[at + 4]);
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint first = 12 * item;
  const int what = int(inputs[first]);
  const vec4 a = vec4(inputs[first + 1], inputs[first + 2], inputs[first + 3], inputs[first + 4]);
  vec4 low = vec4(0.0), high = vec4(0.0);
  if (what == 0) {  // a phase: 1 - nu, 1 + nu, then its lobes
    const CloudPhase phase = phase_of(first + 3);
    low = vec4(cloud_phase(phase, a.x, a.y), cloud_mean_cosine(phase), 0.0, 0.0);
  }
  if (what == 1) {  // droplets: diameter, 1 - nu, 1 + nu
    const CloudPhase phase = droplet_cloud(a.x);
    low = vec4(cloud_phase(phase, a.y, a.z), cloud_mean_cosine(phase), phase.first.one_minus_g, phase.second.one_minus_g);
    high = vec4(phase.second.alpha, phase.second_weight, henyey_greenstein_phase_naive(1.0 - a.y, 1.0 - phase.first.one_minus_g), 0.0);
  }
  if (what == 2) {  // a turn: path, then the lobes from the third on
    const CloudTurn drawn = cloud_turn(phase_of(first + 3), random_stream(uint(a.x), 0u, 5u));
    low = vec4(drawn.turn.one_minus_nu, drawn.turn.one_plus_nu, 0.0, 0.0);
  }
  if (what == 3) {  // exponential integrals
    low = vec4(exponential_integral_1(a.x), exponential_integral_2(a.x), exponential_integral_3(a.x), exponential_integral_2_five_terms(a.x));
    high = vec4(ambient_from_sky(a.x), 0.0, 0.0, 0.0);
  }
  if (what == 4) {  // powder: optical depth to the sun, density, step, strength
    low = vec4(powder(a.x, a.w), published_powder(a.y, a.z, a.w), 0.0, 0.0);
  }
  if (what == 5) {  // octaves: count, 1 - nu, then the lobes; a, b, c and the optical depth to the sun at the end
    const Octaves octaves = Octaves(int(a.x), inputs[first + 8], inputs[first + 9], inputs[first + 10]);
    low = vec4(octave_sum(phase_of(first + 3), octaves, inputs[first + 11], a.y, 2.0 - a.y), 0.0, 0.0, 0.0);
  }
  if (what == 6) {  // optics: liquid water, effective radius
    low = vec4(cloud_extinction_per_km(a.x, a.y), 0.0, 0.0, 0.0);
    const vec3 water = water_absorption_per_m();
    high = vec4(cloud_co_albedo(water.x, a.y), cloud_co_albedo(water.y, a.y), cloud_co_albedo(water.z, a.y), 0.0);
  }
  for (int i = 0; i < 4; ++i) {
    outputs[8 * item + i] = low[i];
    outputs[8 * item + 4 + i] = high[i];
  }
}
