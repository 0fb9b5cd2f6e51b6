// Single scattering along a ray: sunlight that is deflected once, and the directly lit ground. Pure functions; lengths
// in km, radiance in units of the solar irradiance given in the atmosphere (per steradian).
//
//   L = E_sun * integral of  T(eye, t) [ beta_R rho_R P_R + beta_M rho_M P_M ] T(t, sun) V(t) dt  +  lit ground
//
// The rules that fix their samples beforehand are in march.glsl, the rule that places them where the light is in
// adapted_march.glsl, the air on the way to the sun in light_path.glsl.
#ifndef WELKIN_SINGLE_SCATTERING_GLSL
#define WELKIN_SINGLE_SCATTERING_GLSL

#include "05_single_scattering/adapted_march.glsl"
#include "05_single_scattering/march.glsl"

// [lit_ground]
// Radiance of the Lambert ground of albedo 1 under the direct sun, before the view ray's transmittance:
// T(ground, sun) max(mu_sun, 0) / pi.
vec3 lit_ground(Atmosphere atmosphere, float mu_sun, int light_steps, int rule) {
  if (mu_sun <= 0.0) return vec3(0.0, 0.0, 0.0);
  vec3 tau = rule == kRuleAdapted ? optical_depth_and_to_sun(atmosphere, vec3(0.0, 0.0, 0.0), 0.0, mu_sun)
                                  : marched_optical_depth_to_sun(atmosphere, 0.0, mu_sun, light_steps, rule);
  return exp(-tau) * (mu_sun * 0.31830988618379067);
}
// [/lit_ground]

// [single_scattering]
// Radiance and transmittance of a ray: single scattering and the directly lit ground, without the sun's disc.
//   altitude_km     of the camera, any value; below ground counts as on it
//   view_direction  unit vector in the camera's local frame, z up; sun_direction likewise
//   view_steps, light_steps >= 1 samples. Gauss-Legendre rounds both up to a multiple of four; adapted rounds the view
//                   up to four (and needs four for each of two lit pieces) and has a closed form for the way to the sun
//   rule            kRuleLeft ... kRuleAdapted
// A ray that misses the air gives radiance 0 and transmittance 1.
//   with_transmittance  false where only the radiance is used: the adapted rule then leaves that work out
RayLight scattered_light(Atmosphere atmosphere, float altitude_km, vec3 view_direction, vec3 sun_direction,
                         int view_steps, int light_steps, int rule, bool with_transmittance) {
  int view_count = max(view_steps, 1);
  int light_count = max(light_steps, 1);
  if (rule == kRuleGaussLegendre) {
    view_count = (view_count + 3) / 4 * 4;
    light_count = (light_count + 3) / 4 * 4;
  }
  RayLight result;
  result.radiance = vec3(0.0, 0.0, 0.0);
  result.transmittance = vec3(1.0, 1.0, 1.0);
  AirRay ray = enter_air(atmosphere, altitude_km, view_direction, sun_direction);
  if (!ray.hits_air) return result;
  ScatteringTowardsEye scattering = scattering_towards_eye(atmosphere, one_minus_cosine(view_direction, sun_direction),
                                                           one_minus_cosine(view_direction, sun_direction * -1.0));
  if (rule == kRuleAdapted) {
    result = adapted_march(atmosphere, ray, scattering, view_count, with_transmittance || ray.hits_ground);
  } else {
    result = fixed_march(atmosphere, ray, scattering, view_count, light_count, rule);
  }
  if (ray.hits_ground) {
    float mu_sun = mu_sun_along(ray, atmosphere.ground_radius_km, ray.length_km, 0.0);
    result.radiance +=
        result.transmittance * atmosphere.ground_albedo * lit_ground(atmosphere, mu_sun, light_count, rule);
  }
  result.radiance *= atmosphere.solar_irradiance;
  return result;
}

// The same, always with the transmittance.
RayLight single_scattering(Atmosphere atmosphere, float altitude_km, vec3 view_direction, vec3 sun_direction,
                           int view_steps, int light_steps, int rule) {
  return scattered_light(atmosphere, altitude_km, view_direction, sun_direction, view_steps, light_steps, rule, true);
}
// [/single_scattering]

#endif
