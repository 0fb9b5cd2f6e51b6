// The air between the eye and what it sees: radiance it adds, and the part of the light behind it lets through. Pure
// functions; km. Besides what chapter 09's functions ask for, the including file gives
//   const bool HIGHER_ORDERS                                      chapter 09's table is there
//   float sun_behind_terrain(float t_km, float altitude_km)       share of the sun's disc seen from there, 0 ... 1
//
//   L(d) = E_sun * integral from 0 to d of T(0, t) [ (beta_R rho_R P_R + beta_M rho_M P_M) T(t, sun) V(t) + S(t) ] dt
// S: chapter 09's source, light scattered before, that is scattered towards the eye. V: the terrain's shadow on sunlight;
// light of higher orders comes from all around and is not shadowed.
#ifndef WELKIN_AERIAL_GLSL
#define WELKIN_AERIAL_GLSL

#include "09_multiple_scattering_lut/multiple_scattering.glsl"

// Transmittance of (method's) air from a point to the top; 0 where the planet is in the way.
vec3 sun_through_air(Atmosphere air, float altitude_km, float mu_sun) {
  if (!sun_above_horizon(air.shape.x, altitude_km, mu_sun)) return vec3(0.0, 0.0, 0.0);
  return exp(extinction(air, sun_columns(air, altitude_km, mu_sun)) * -1.0);
}

// [air_segment]
// The air from t_a to t_b, behind what `before` holds. One node in the middle, or pairs of Gauss-Legendre nodes; each is a
// piece of constant source and extinction. Pieces tile the segment: nothing is left out at its end, wherever that is.
RayLight behind(MethodAir method, AirRay ray, ScatteringTowardsEye scattering, RayLight before, float t_a, float t_b,
                int samples) {
  Atmosphere air = method.air;
  RayLight light = before;
  float dt = (t_b - t_a) / float(samples);
  for (int i = 0; i < samples; i++) {
    float offset = samples == 1 ? 0.5 : (i % 2 == 0 ? 0.42264973081037424 : 0.57735026918962576);
    CountedPoint point;
    point.t_km = t_a + (float(i) + offset) * dt;
    point.altitude_km = max(altitude_along(air.shape.x, ray.altitude_km, ray.mu, point.t_km), 0.0);
    point.s_km = (air.shape.x + ray.altitude_km) * ray.mu + point.t_km;
    point.dt_dx = 1.0;
    if (point.altitude_km <= air.shape.y) {
      vec3 density = densities(air, point.altitude_km);
      vec3 tau = extinction(air, density) * dt;
      float mu_sun = mu_sun_along(ray, air.shape.x, point.t_km, point.altitude_km);
      vec3 source = (scattering.rayleigh * density.x + scattering.mie * density.y) * sun_through_air(air, point.altitude_km, mu_sun) *
                    sun_behind_terrain(point.t_km, point.altitude_km);
      if (HIGHER_ORDERS) source += source_at(air, ray, point, density, method.chi, kSourceTable);
      vec3 mean = vec3(mean_transmittance(tau.x), mean_transmittance(tau.y), mean_transmittance(tau.z));
      light.radiance += light.transmittance * source * mean * dt;
      light.transmittance *= exp(tau * -1.0);
    }
  }
  return light;
}
// [/air_segment]

RayLight no_air() {
  RayLight light;
  light.radiance = vec3(0.0, 0.0, 0.0);
  light.transmittance = vec3(1.0, 1.0, 1.0);
  return light;
}

// [slices]
// Distance of the far end of the first s of n slices, d = d_max (s / n)^power; and how many slices lie before a distance.
float slice_end(float s, float slices, float farthest_km, float power) { return farthest_km * pow(s / slices, power); }
float slices_before(float t_km, float slices, float farthest_km, float power) {
  return slices * pow(clamp(t_km / farthest_km, 0.0, 1.0), 1.0 / power);
}
// [/slices]

// [first_slice]
// The first slice up to the share x of its length, from what is stored for its end. Between the eye (L = 0, T = 1) and that
// end lies no texel to interpolate with: the slice is taken as homogeneous,
//   T(x) = T^x,      L(x) = L (1 - T^x) / (1 - T),      and 1 - T^x = x tau phi(x tau), phi the mean transmittance.
RayLight within_first_slice(RayLight whole, float x) {
  vec3 tau = log(max(whole.transmittance, vec3(1.0e-30, 1.0e-30, 1.0e-30))) * -1.0;
  vec3 share = vec3(mean_transmittance(tau.x * x) / mean_transmittance(tau.x), mean_transmittance(tau.y * x) / mean_transmittance(tau.y),
                    mean_transmittance(tau.z * x) / mean_transmittance(tau.z));
  RayLight part;
  part.radiance = whole.radiance * share * x;
  part.transmittance = exp(tau * (x * -1.0));
  return part;
}
// [/first_slice]

// [march_to]
// All the air up to distance d: the same slices, laid so that the last ends there.
RayLight march_to(MethodAir method, AirRay ray, ScatteringTowardsEye scattering, float d_km, int slices, int samples, float power) {
  RayLight light = no_air();
  float t_a = 0.0;
  for (int k = 0; k < slices; k++) {
    float t_b = slice_end(float(k + 1), float(slices), d_km, power);
    light = behind(method, ray, scattering, light, t_a, t_b, samples);
    t_a = t_b;
  }
  return light;
}
// [/march_to]

// A ray for the march to something inside the air: as enter_air(), but it does not end at the ground, whose mesh lies a
// little above or below the sphere.
ScatteringTowardsEye scattering_along(Atmosphere atmosphere, vec3 view, vec3 sun) {
  return scattering_towards_eye(atmosphere, one_minus_cosine(view, sun), one_minus_cosine(view, sun * -1.0));
}

#endif
