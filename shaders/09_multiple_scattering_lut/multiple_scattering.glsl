// Marches a ray through the sky with all orders of scattering: chapter 05's first order, and light of the table
// scattered towards the eye along the ray. Pure functions; km, radiance in units of the atmosphere's solar irradiance.
#ifndef WELKIN_MULTIPLE_SCATTERING_GLSL
#define WELKIN_MULTIPLE_SCATTERING_GLSL

#include "09_multiple_scattering_lut/gather.glsl"

// [all_orders]
// The first order of a ray, with the ground lit by sun and sky. The transmittance is only computed for rays that end on
// the ground.
RayLight first_order_light(MethodAir method, Atmosphere atmosphere, AirRay ray, vec3 view_direction, vec3 sun_direction,
                           int view_steps) {
  ScatteringTowardsEye scattering = scattering_towards_eye(atmosphere, one_minus_cosine(view_direction, sun_direction),
                                                           one_minus_cosine(view_direction, sun_direction * -1.0));
  RayLight light = adapted_march(method.air, ray, scattering, max(view_steps, 1), ray.hits_ground);
  if (ray.hits_ground) {
    float mu_sun = mu_sun_along(ray, atmosphere.ground_radius_km, ray.length_km, 0.0);
    vec3 lit = lit_ground(method.air, mu_sun, 1, kRuleAdapted);
    if (MS_METHOD != kMethodPublished) lit += sky_irradiance(atmosphere, 0.0, mu_sun) * 0.31830988618379067;
    light.radiance += light.transmittance * atmosphere.ground_albedo * lit;
  }
  return light;
}

// The higher orders: light of the table, scattered towards the eye.
vec3 higher_orders_light(MethodAir method, AirRay ray, int source_steps) {
  return source_march(method.air, source_ray(method.air, ray), source_steps, method.chi);
}

// Radiance of all orders and transmittance of a ray, without the sun's disc. Arguments as for scattered_light() of
// chapter 05, with its adapted rule.
//   source_steps  samples of the table along the ray, rounded up to a multiple of four
// The method of moments marches the delta-scaled air, whose direct beam includes the light that the aerosol scatters
// straight on. The first order keeps the true phase function (Nakajima and Tanaka 1988, "TMS"). The transmittance is
// that of the true air.
RayLight all_orders_light(Atmosphere atmosphere, float altitude_km, vec3 view_direction, vec3 sun_direction,
                          int view_steps, int source_steps, bool with_transmittance) {
  RayLight result;
  result.radiance = vec3(0.0, 0.0, 0.0);
  result.transmittance = vec3(1.0, 1.0, 1.0);
  AirRay ray = enter_air(atmosphere, altitude_km, view_direction, sun_direction);
  if (!ray.hits_air) return result;
  MethodAir method = method_air(atmosphere, MS_METHOD);
  result.radiance = first_order_light(method, atmosphere, ray, view_direction, sun_direction, view_steps).radiance;
  result.radiance += higher_orders_light(method, ray, source_steps);
  if (with_transmittance) result.transmittance = ray_transmittance(atmosphere, source_ray(atmosphere, ray));
  result.radiance *= atmosphere.solar_irradiance;
  return result;
}
// [/all_orders]

#endif
