// The published terms of light in clouds that stand in for scattering of higher orders. Pure functions.
//
// Each multiplies or sums in-scattered light; none changes the transmittance.
#ifndef WELKIN_IN_SCATTER_GLSL
#define WELKIN_IN_SCATTER_GLSL

#include "18_cloud_light/cloud_phase.glsl"
#include "18_cloud_light/exponential_integrals.glsl"

// [powder]
// Powder: edges of a cloud that face the sun have little cloud before them which could scatter light their way. 1 - exp(-2 tau),
// tau the optical depth from the point to the sun. It multiplies in-scattered light. strength 0 leaves it out.
float powder(float tau_sun, float strength) { return 1.0 - strength * exp(-2.0 * max(tau_sun, 0.0)); }

// As it is published in code: the argument is the density at the point times the length of the march's step, and the factor
// multiplies the step's transmittance. The picture then depends on the number of steps. For the demonstration alone.
float published_powder(float density, float step_km, float strength) { return 1.0 - strength * exp(-2.0 * density * step_km); }
// [/powder]

// [octaves]
// Wrenninge's octaves: sum over i of b^i P(c^i g) exp(-a^i tau_sun). Octave i stands for light that was scattered i times more:
// it comes from all sides (c^i g, a broader phase function) and from farther (a^i tau). Over the whole depth octave i gives
// (b/a)^i of the first, so b <= a, and b < a if the sum is to converge.
struct Octaves {
  int count;
  float a;  // extinction
  float b;  // contribution
  float c;  // anisotropy
};

// g is scaled, never the cosine: that would be no phase function any more.
PhaseLobe octave_lobe(PhaseLobe lobe, float scale) {
  PhaseLobe scaled = lobe;
  scaled.one_minus_g = 1.0 - scale * (1.0 - lobe.one_minus_g);
  return scaled;
}

float octave_phase(CloudPhase phase, float scale, float one_minus_nu, float one_plus_nu) {
  CloudPhase scaled = phase;
  scaled.first = octave_lobe(phase.first, scale);
  scaled.second = octave_lobe(phase.second, scale);
  return cloud_phase(scaled, one_minus_nu, one_plus_nu);
}

float octave_sum(CloudPhase phase, Octaves octaves, float tau_sun, float one_minus_nu, float one_plus_nu) {
  float sum = cloud_phase(phase, one_minus_nu, one_plus_nu) * exp(-tau_sun);
  float a = octaves.a;
  float b = octaves.b;
  float c = octaves.c;
  for (int i = 1; i < octaves.count; i++) {
    sum += b * octave_phase(phase, c, one_minus_nu, one_plus_nu) * exp(-a * tau_sun);
    a *= octaves.a;
    b *= octaves.b;
    c *= octaves.c;
  }
  return sum;
}
// [/octaves]

// [ambient]
// Light of an isotropic sky of radiance 1 that comes down through tau_above, scattered at the point evenly into all directions:
// half E2(tau), the mean of the sky's radiance over the sphere. The same from the ground, with tau_below.
float ambient_from_sky(float tau_above) { return 0.5 * exponential_integral_2(tau_above); }

// Radiance of a Lambert ground of this albedo, lit by the flux that a cloud lets through: E/pi times the albedo.
float ground_radiance(float albedo, float irradiance) { return albedo * irradiance * 0.31830988618379067; }
// [/ambient]

#endif
