// Light arriving at a point, as its first moments over direction, and what the air scatters of it. Pure functions.
//
// L(d) is the radiance seen when looking along d. Its moments: the mean J = (1/4pi) int L, the flux F_i = int L d_i, the
// tensor K_ij = int L d_i d_j. A phase function P = (1/4pi) sum (2l+1) chi_l P_l sends towards an eye that looks along v
//   int L(d) P(d.v) dd = J [ 1 + 3 chi_1 f.v + 5 chi_2 (3/2 v.k.v - 1/2) + ... ],     f = F/(4 pi J), k = K/(4 pi J)
// Rayleigh's has chi_1 = 0, chi_2 = 1/10 and nothing more: for it the three terms are exact.
#ifndef WELKIN_MOMENTS_GLSL
#define WELKIN_MOMENTS_GLSL

#include "04_air/medium.glsl"

// Per channel; per unit of solar irradiance. x: horizontal, towards the sun; z: up. By symmetry the y moments vanish.
struct Moments {
  vec3 mean;        // J, 1/sr
  vec3 z;           // f_z
  vec3 x;           // f_x
  vec3 zz;          // k_zz
  vec3 xz;          // k_xz
  vec3 xx_yy;       // k_xx - k_yy
  vec3 irradiance;  // diffuse irradiance on a horizontal plane from above, over pi J
};

// [mie_moments]
// chi_1, chi_2, chi_3 of the aerosol's phase function. Henyey-Greenstein: g^l. Draine's is it times (1 + alpha nu^2), and
// nu^2 P_l is a sum of P_(l+2), P_l, P_(l-2).
vec3 draine_moments(float g, float alpha) {
  float g2 = g * g;
  float g3 = g2 * g;
  vec3 plain = vec3(g, g2, g3);
  vec3 squared = vec3(0.4 * g3 + 0.6 * g, (12.0 * g2 * g2) / 35.0 + (11.0 * g2) / 21.0 + 2.0 / 15.0,
                      (20.0 * g3 * g2) / 63.0 + (23.0 * g3) / 45.0 + (6.0 * g) / 35.0);
  return (plain + squared * alpha) / (1.0 + alpha * (1.0 + 2.0 * g2) / 3.0);
}

vec3 mie_moments(Atmosphere atmosphere) {
  float g = atmosphere.mie_g;
  if (MIE_PHASE == 1) return draine_moments(g, 1.0);
  if (MIE_PHASE == 2) return draine_moments(g, atmosphere.mie_alpha);
  vec3 first = draine_moments(g, 0.0);
  if (MIE_PHASE == 3) return first * (1.0 - atmosphere.mie_alpha) + draine_moments(atmosphere.second_g, 0.0) * atmosphere.mie_alpha;
  return first;
}
// [/mie_moments]

// [scaled_air]
// Delta scaling (Wiscombe 1977, delta-M): the share chi_3 of what the aerosol scatters goes on almost straight ahead. It is
// counted as not scattered; what is left has the moments (chi_l - chi_3) / (1 - chi_3). Moments up to the second remain
// exact, and the rest of the lobe is broad.
float straight_share(vec3 chi) { return clamp(chi.z, 0.0, 0.99); }

Atmosphere scaled_air(Atmosphere atmosphere, float share) {
  Atmosphere scaled = atmosphere;
  vec3 straight = atmosphere.mie_scattering * share;
  vec3 scattering = atmosphere.mie_scattering - straight;
  vec3 lost = max(atmosphere.mie_extinction - straight, vec3(0.0, 0.0, 0.0));
  scaled.mie_scattering = scattering;
  scaled.mie_extinction = lost;
  return scaled;
}

vec2 scaled_moments(vec3 chi, float share) {
  return vec2(chi.x - share, chi.y - share) / (1.0 - share);
}
// [/scaled_air]

// [source]
// Radiance gained per km (for densities) or per count (for densities times km per count) towards an eye that looks along v.
//   molecules, aerosol  their scattering coefficients there, or what stands for them
//   look_z  v_z;   look_x  v_x, its part towards the sun;   chi: moments 1 and 2 of the (scaled) aerosol
vec3 scattered_towards_eye(vec3 molecules, vec3 aerosol, Moments light, vec2 chi, float look_x, float look_z) {
  float look_y2 = max(1.0 - look_x * look_x - look_z * look_z, 0.0);
  vec3 along = light.x * look_x + light.z * look_z;
  // k_xx + k_yy = 1 - k_zz.
  vec3 quadratic = light.zz * (look_z * look_z) + light.xz * (2.0 * look_x * look_z) +
                   (vec3(1.0, 1.0, 1.0) - light.zz) * (0.5 * (1.0 - look_z * look_z)) + light.xx_yy * (0.5 * (look_x * look_x - look_y2));
  vec3 second = quadratic * 1.5 - vec3(0.5, 0.5, 0.5);
  vec3 source = molecules + aerosol + aerosol * along * (3.0 * chi.x) + (molecules * 0.1 + aerosol * chi.y) * second * 5.0;
  return light.mean * max(source, vec3(0.0, 0.0, 0.0));
}

// v_x from nu = v.s: v_x sin = nu - mu mu_sun. A sun at the zenith has no horizontal direction, and no moment needs one.
float look_x_from(float nu, float mu_sun, float look_z) {
  float sine_sun = sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 1.0e-6));
  float level = sqrt(max((1.0 - look_z) * (1.0 + look_z), 0.0));
  return clamp((nu - look_z * mu_sun) / sine_sun, -level, level);
}

// The same for the sun's beam, whose moments are those of one direction: 4 pi times the phase functions, of two moments, of
// (molecules, aerosol).
vec2 broad_phases(vec2 chi, float nu) {
  float second = 1.5 * nu * nu - 0.5;
  return vec2(1.0 + 0.5 * second, max(1.0 + 3.0 * chi.x * nu + 5.0 * chi.y * second, 0.0));
}
// [/source]

#endif
