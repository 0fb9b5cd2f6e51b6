// The radiance arriving at a point, as its first moments over direction, and the in-scattering from it. Pure functions.
//
// L(d) is the radiance seen in direction d. Its moments: the mean J = (1/4pi) int L, the flux F_i = int L d_i, the
// tensor K_ij = int L d_i d_j. With a phase function P = (1/4pi) sum (2l+1) chi_l P_l, the in-scattered radiance in the
// view direction v is
//   int L(d) P(d.v) dd = J [ 1 + 3 chi_1 f.v + 5 chi_2 (3/2 v.k.v - 1/2) + ... ],     f = F/(4 pi J), k = K/(4 pi J)
// Rayleigh's phase function has chi_1 = 0, chi_2 = 1/10 and no higher moments: for it the three terms are exact.
#ifndef WELKIN_MOMENTS_GLSL
#define WELKIN_MOMENTS_GLSL

#include "04_air/medium.glsl"

// Per channel and unit of solar irradiance. x: horizontal, towards the sun; z: up. By symmetry the y moments vanish.
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
// chi_1, chi_2, chi_3 of the aerosol's phase function. Henyey-Greenstein has g^l. Draine's is Henyey-Greenstein times
// (1 + alpha nu^2), normalized; nu^2 P_l is a sum of P_(l+2), P_l, P_(l-2).
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
  if (MIE_PHASE == 3)
    return first * (1.0 - atmosphere.mie_alpha) + draine_moments(atmosphere.second_g, 0.0) * atmosphere.mie_alpha;
  return first;
}
// [/mie_moments]

// [delta_scaled_air]
// Delta scaling (Wiscombe 1977, delta-M): the fraction chi_3 of the light that the aerosol scatters goes almost
// straight on. It counts as not scattered. The rest has a broad phase function with the moments
// (chi_l - chi_3) / (1 - chi_3): moments up to the second remain exact.
float forward_fraction(vec3 chi) { return clamp(chi.z, 0.0, 0.99); }

Atmosphere delta_scaled_air(Atmosphere atmosphere, float fraction) {
  Atmosphere scaled = atmosphere;
  vec3 forward = atmosphere.mie_scattering * fraction;
  vec3 mie_scattering = atmosphere.mie_scattering - forward;
  vec3 mie_extinction = max(atmosphere.mie_extinction - forward, vec3(0.0, 0.0, 0.0));
  scaled.mie_scattering = mie_scattering;
  scaled.mie_extinction = mie_extinction;
  return scaled;
}

vec2 delta_scaled_moments(vec3 chi, float fraction) {
  return vec2(chi.x - fraction, chi.y - fraction) / (1.0 - fraction);
}
// [/delta_scaled_air]

// [source]
// Radiance in-scattered per km in the view direction v; linear in the scattering coefficients, so per count where they
// are per count.
//   rayleigh_scattering, mie_scattering   scattering coefficients at the point
//   view_x   v_x, towards the sun;   mu   v_z;   chi   moments 1 and 2 of the (scaled) aerosol
vec3 scattered_towards_eye(vec3 rayleigh_scattering, vec3 mie_scattering, Moments light, vec2 chi, float view_x,
                           float mu) {
  float view_y2 = max(1.0 - view_x * view_x - mu * mu, 0.0);
  vec3 along = light.x * view_x + light.z * mu;
  // k_xx + k_yy = 1 - k_zz.
  vec3 quadratic = light.zz * (mu * mu) + light.xz * (2.0 * view_x * mu) +
                   (vec3(1.0, 1.0, 1.0) - light.zz) * (0.5 * (1.0 - mu * mu)) +
                   light.xx_yy * (0.5 * (view_x * view_x - view_y2));
  vec3 second = quadratic * 1.5 - vec3(0.5, 0.5, 0.5);
  vec3 source = rayleigh_scattering + mie_scattering + mie_scattering * along * (3.0 * chi.x) +
                (rayleigh_scattering * 0.1 + mie_scattering * chi.y) * second * 5.0;
  return light.mean * max(source, vec3(0.0, 0.0, 0.0));
}

// v_x from nu = v.s: v_x sqrt(1 - mu_sun^2) = nu - mu mu_sun. A sun at the zenith has no azimuth; there the moments
// that v_x multiplies vanish.
float view_x_from(float nu, float mu_sun, float mu) {
  float sine_sun = sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 1.0e-6));
  float sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  return clamp((nu - mu * mu_sun) / sine_sun, -sine, sine);
}

// 4 pi times the phase functions (rayleigh, mie) with only the moments 1 and 2: the same sum for the sun's beam, whose
// radiance comes from one direction.
vec2 two_moment_phases(vec2 chi, float nu) {
  float second = 1.5 * nu * nu - 0.5;
  return vec2(1.0 + 0.5 * second, max(1.0 + 3.0 * chi.x * nu + 5.0 * chi.y * second, 0.0));
}
// [/source]

#endif
