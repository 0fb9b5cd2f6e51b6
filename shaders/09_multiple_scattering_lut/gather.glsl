// Light that arrives at a point from one direction, for the table: the first order, and one more order from a table of the
// orders before. Pure functions; km, radiance per unit of solar irradiance.
#ifndef WELKIN_GATHER_GLSL
#define WELKIN_GATHER_GLSL

#include "05_single_scattering/single_scattering.glsl"
#include "09_multiple_scattering_lut/directions.glsl"
#include "09_multiple_scattering_lut/source_march.glsl"

// What a method makes of the air: scaled or as it is, and the aerosol's moments.
struct MethodAir {
  Atmosphere air;
  vec2 chi;
};

MethodAir method_air(Atmosphere atmosphere, int method) {
  MethodAir result;
  result.air = atmosphere;
  result.chi = vec2(0.0, 0.0);
  if (method != kMethodMoments || !HAS_MIE) return result;
  vec3 chi = mie_moments(atmosphere);
  float share = straight_share(chi);
  result.air = scaled_air(atmosphere, share);
  result.chi = scaled_moments(chi, share);
  return result;
}

vec3 sun_at(float mu_sun) { return vec3(sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 0.0)), 0.0, mu_sun); }

// [published]
// The second order seen from a point along one direction, everything isotropic, and the share of isotropic light that
// comes from there: the two integrands of Hillaire 2020, equations 5 and 7.
struct Transfer {
  vec3 second;
  vec3 transfer;
};

ScatteringTowardsEye isotropic_scattering(Atmosphere atmosphere) {
  ScatteringTowardsEye scattering;
  scattering.rayleigh = HAS_RAYLEIGH ? vec3(atmosphere.rayleigh) * 0.079577471545947668 : vec3(0.0, 0.0, 0.0);
  scattering.mie = HAS_MIE ? vec3(atmosphere.mie_scattering) * 0.079577471545947668 : vec3(0.0, 0.0, 0.0);
  return scattering;
}

// Sunlight the ground returns: albedo / pi, and the cosine of the sun there, which lit_ground() holds.
vec3 ground_bounce(Atmosphere atmosphere, AirRay ray) {
  return vec3(atmosphere.ground) * lit_ground(atmosphere, mu_sun_along(ray, atmosphere.shape.x, ray.length_km, 0.0), 1, kRuleAdapted);
}

Transfer published_transfer(Atmosphere atmosphere, float altitude_km, vec3 look, vec3 sun, int steps) {
  Transfer result;
  result.second = vec3(0.0, 0.0, 0.0);
  result.transfer = vec3(0.0, 0.0, 0.0);
  AirRay ray = enter_air(atmosphere, altitude_km, look, sun);
  if (!ray.hits_air) return result;
  RayLight light = adapted_march(atmosphere, ray, isotropic_scattering(atmosphere), steps, ray.hits_ground);
  result.second = light.radiance;
  if (ray.hits_ground) result.second += light.transmittance * ground_bounce(atmosphere, ray);
  result.transfer = source_march(atmosphere, source_ray(atmosphere, ray), steps, vec2(0.0, 0.0), kSourceUnit);
  return result;
}

// Psi = L2 / (1 - f). f reaches 1 where nothing is absorbed and nothing escapes: 0.999 stands for a thousand orders, and
// keeps the quotient finite when quadrature takes f past 1.
vec3 close_series(vec3 second, vec3 transfer) {
  return second / (vec3(1.0, 1.0, 1.0) - clamp(transfer, vec3(0.0, 0.0, 0.0), vec3(0.999, 0.999, 0.999)));
}
// [/published]

// [orders]
// Light scattered once, with the phase functions the method has moments for.
vec3 first_order(MethodAir method, float altitude_km, vec3 look, vec3 sun, int steps) {
  AirRay ray = enter_air(method.air, altitude_km, look, sun);
  if (!ray.hits_air) return vec3(0.0, 0.0, 0.0);
  ScatteringTowardsEye scattering = isotropic_scattering(method.air);
  if (MS_METHOD == kMethodMoments) scattering = broad_scattering(method.air, method.chi, ray.nu);
  RayLight light = adapted_march(method.air, ray, scattering, steps, ray.hits_ground);
  if (ray.hits_ground) light.radiance += light.transmittance * ground_bounce(method.air, ray);
  return light.radiance;
}

// Light scattered once more than the light in the table, of which the ground returns its part, too.
vec3 next_order(MethodAir method, float altitude_km, vec3 look, vec3 sun, int steps) {
  AirRay ray = enter_air(method.air, altitude_km, look, sun);
  if (!ray.hits_air) return vec3(0.0, 0.0, 0.0);
  SourceRay along = source_ray(method.air, ray);
  vec3 radiance = source_march(method.air, along, steps, method.chi, kSourceTable);
  if (ray.hits_ground) {
    float mu_sun = mu_sun_along(ray, method.air.shape.x, ray.length_km, 0.0);
    radiance += ray_transmittance(method.air, along) * vec3(method.air.ground) * sky_irradiance(method.air, 0.0, mu_sun) * 0.31830988618379067;
  }
  return radiance;
}
// [/orders]

#endif
