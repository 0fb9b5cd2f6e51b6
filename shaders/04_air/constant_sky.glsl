// The sky of air that has one density everywhere, in closed form: the first thing one would try.
//
// All constituents are mixed into a shell as thick as the air's scale height H, each spread so that its vertical column
// is the true one: sigma = sum_i beta_i H_i / H. Along the view ray the optical depth to a point and from there to the
// sun changes linearly if the shell is flat, from A at the near end to B at the far end, and then
//   L = S integral_0^L exp(-(A + (B - A) t/L)) dt = S L exp(-min(A,B)) phi(|B - A|),   phi(x) = (1 - exp(-x))/x.
// On the round shell it is not linear: the form is kept, with A and B taken from the round shell. The planet casts no
// shadow on its air: light passes through it as if it were air. Chapter 05 corrects both. Units: km, 1/km.
#ifndef WELKIN_CONSTANT_SKY_GLSL
#define WELKIN_CONSTANT_SKY_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"
#include "04_air/medium.glsl"

// Share of depolarised light of air at 550 nm, from its King factor (air.hpp: depolarization).
const float AIR_DEPOLARIZATION = 0.0283;

// [mean_transmittance]
// (1 - exp(-x)) / x for x >= 0, in float32: the quotient is 0/0 at x = 0 and has lost half its digits long before.
float phi(float x) {
  return x < 0.05 ? 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))) : (1.0 - exp(-x)) / x;
}

// Mean of exp(-tau) while tau runs evenly from one optical depth to another. No argument of exp is positive.
vec3 mean_transmittance(vec3 tau_a, vec3 tau_b) {
  vec3 low = min(tau_a, tau_b);
  vec3 span = abs(tau_b - tau_a);
  return vec3(exp(-low.x) * phi(span.x), exp(-low.y) * phi(span.y), exp(-low.z) * phi(span.z));
}
// [/mean_transmittance]

// Which phase functions are compiled in. PHASE_DETAIL 0: isotropic; 1: Rayleigh's for the molecules; 2: also
// Henyey-Greenstein's for the aerosol; 3: the scene's for the aerosol instead; 4: also the anisotropy of the molecules.
float molecule_phase(float one_minus_nu) {
  if (PHASE_DETAIL == 0) return isotropic_phase();
  if (PHASE_DETAIL == 4) return rayleigh_anisotropic_phase(one_minus_nu, AIR_DEPOLARIZATION);
  return rayleigh_phase(one_minus_nu);
}

float aerosol_phase(Atmosphere atmosphere, float one_minus_nu, float one_plus_nu) {
  if (PHASE_DETAIL <= 1) return isotropic_phase();
  if (PHASE_DETAIL == 2) return henyey_greenstein_lobe(one_minus_nu, one_plus_nu, atmosphere.mie_g);
  return mie_phase(atmosphere, one_minus_nu, one_plus_nu);
}

struct ConstantSky {
  vec3 radiance;       // per unit solar irradiance
  vec3 transmittance;  // of the air along the whole ray, also where that ends on the ground
  float hits_ground;   // 1 if the ray ends on the ground
};

// altitude_km >= 0; view and sun: unit vectors in the local frame, z up.
// [constant_sky]
ConstantSky constant_sky(Atmosphere atmosphere, float altitude_km, vec3 view, vec3 sun) {
  float radius = atmosphere.ground_radius_km;
  float thickness = HAS_RAYLEIGH ? atmosphere.rayleigh_scale_height_km
                    : HAS_MIE    ? atmosphere.mie_scale_height_km
                                 : atmosphere.ozone_half_width_km;
  float shell = min(thickness, atmosphere.top_km);
  // Densities that give each constituent its true vertical column: H of an exponential, the half width of a tent.
  vec3 density = vec3(0.0);
  if (HAS_RAYLEIGH) density.x = atmosphere.rayleigh_scale_height_km / shell;
  if (HAS_MIE) density.y = atmosphere.mie_scale_height_km / shell;
  if (HAS_OZONE) density.z = atmosphere.ozone_half_width_km / shell;
  vec3 sigma = extinction(atmosphere, density);

  ConstantSky sky = ConstantSky(vec3(0.0), vec3(1.0), 0.0);
  float h = altitude_km;
  float mu = view.z;
  float sine = length(view.xy);
  float mu_sun = sun.z;
  float one_minus_nu = one_minus_cosine(view, sun);
  float nu = 1.0 - one_minus_nu;
  if (h > shell) {  // from outside: go to where the ray enters; angles are from the zenith there
    float t = distance_to_shell_from_outside(radius, h, mu, sine, shell);
    if (t < 0.0) return sky;
    float r = radius + h, r_entry = radius + shell;
    mu = clamp((r * mu + t) / r_entry, -1.0, 1.0);
    sine = min(r * sine / r_entry, 1.0);
    mu_sun = clamp((r * mu_sun + t * nu) / r_entry, -1.0, 1.0);
    h = shell;
  }
  float to_ground = distance_to_shell_from_outside(radius, h, mu, sine, 0.0);
  bool ground = to_ground >= 0.0;
  float way = ground ? to_ground : distance_to_shell_from_inside(radius, h, mu, shell);
  float h_end = ground ? 0.0 : shell;
  float mu_sun_end = clamp(((radius + h) * mu_sun + way * nu) / (radius + h_end), -1.0, 1.0);
  vec3 sun_near = min(sigma * distance_to_shell_from_inside(radius, h, mu_sun, shell), 1.0e30);
  vec3 sun_far = min(sigma * distance_to_shell_from_inside(radius, h_end, mu_sun_end, shell), 1.0e30);
  vec3 tau = min(sigma * way, 1.0e30);

  vec3 source = vec3(0.0);
  if (HAS_RAYLEIGH) source += atmosphere.rayleigh_scattering * (density.x * molecule_phase(one_minus_nu));
  if (HAS_MIE)
    source += atmosphere.mie_scattering *
              (density.y * aerosol_phase(atmosphere, one_minus_nu, one_minus_cosine(view, -sun)));
  sky.radiance = source * way * mean_transmittance(sun_near, tau + sun_far);
  sky.transmittance = exp(-tau);
  if (ground) {
    sky.hits_ground = 1.0;
    sky.radiance += atmosphere.ground_albedo * (0.3183098861837907 * max(mu_sun_end, 0.0)) * exp(-(tau + sun_far));
  }
  sky.radiance *= atmosphere.solar_irradiance;
  return sky;
}
// [/constant_sky]

#endif
