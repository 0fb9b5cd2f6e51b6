// The air's three constituents and what they do to light. Pure functions; km and 1/km.
//
// The including file says which constituents exist: HAS_RAYLEIGH, HAS_MIE, HAS_OZONE (const bool) and MIE_PHASE (const
// int: 0 henyey_greenstein, 1 cornette_shanks, 2 draine, 3 double_hg). What does not exist costs nothing.
//   densities      (exp(-h/H_R), exp(-h/H_M), max(0, 1 - |h - peak| / half_width))
//   extinction     sigma(h) = beta_R rho_R + beta_M,ext rho_M + beta_O rho_O
//   optical depth  the same sum over columns, the densities' integrals along a path in km
#ifndef WELKIN_MEDIUM_GLSL
#define WELKIN_MEDIUM_GLSL

#include "interop/atmosphere.h"
#include "04_air/phase.glsl"

float ozone_density(Atmosphere atmosphere, float altitude_km) {
  return max(1.0 - abs(altitude_km - atmosphere.ozone_peak_km) * (1.0 / atmosphere.ozone_half_width_km), 0.0);
}

// Densities (rayleigh, mie, ozone) relative to the ground, the ground and ozone's peak; 0 for what does not exist.
// It multiplies by reciprocals, which a compiler may compute once before a loop; divisions it must leave inside.
vec3 densities(Atmosphere atmosphere, float altitude_km) {
  vec3 density = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) density.x = exp(altitude_km * (-1.0 / atmosphere.rayleigh_scale_height_km));
  if (HAS_MIE) density.y = exp(altitude_km * (-1.0 / atmosphere.mie_scale_height_km));
  if (HAS_OZONE) density.z = ozone_density(atmosphere, altitude_km);
  return density;
}

// Extinction in 1/km from densities, or optical depth from columns in km. What does not exist has density 0.
vec3 extinction(Atmosphere atmosphere, vec3 density) {
  return atmosphere.rayleigh_scattering * density.x +
         atmosphere.mie_extinction * density.y + atmosphere.ozone_absorption * density.z;
}

float mie_phase(Atmosphere atmosphere, float one_minus_nu, float one_plus_nu) {
  float g = atmosphere.mie_g;
  if (MIE_PHASE == 1) return cornette_shanks_phase(g >= 0.0 ? one_minus_nu : one_plus_nu, abs(g));
  if (MIE_PHASE == 2) return draine_phase(g >= 0.0 ? one_minus_nu : one_plus_nu, abs(g), atmosphere.mie_alpha);
  if (MIE_PHASE == 3) return double_hg_phase(one_minus_nu, one_plus_nu, g, atmosphere.second_g, atmosphere.mie_alpha);
  return henyey_greenstein_lobe(one_minus_nu, one_plus_nu, g);
}

// Scattering coefficient times phase function, 1/(km sr), of (rayleigh, mie) at unit density.
struct ScatteringTowardsEye {
  vec3 rayleigh;
  vec3 mie;
};

ScatteringTowardsEye scattering_towards_eye(Atmosphere atmosphere, float one_minus_nu, float one_plus_nu) {
  ScatteringTowardsEye scattering;
  scattering.rayleigh = vec3(0.0, 0.0, 0.0);
  scattering.mie = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) scattering.rayleigh = atmosphere.rayleigh_scattering * rayleigh_phase(one_minus_nu);
  if (HAS_MIE) scattering.mie = atmosphere.mie_scattering * mie_phase(atmosphere, one_minus_nu, one_plus_nu);
  return scattering;
}

#endif
