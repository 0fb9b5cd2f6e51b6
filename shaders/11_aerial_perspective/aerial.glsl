// The air between the eye and what it sees: the radiance it adds, and the share of the light behind it that it lets
// through. Pure functions; km. Besides what chapter 09's functions ask for, the including file gives
//   const bool HIGHER_ORDERS                                      chapter 09's table is there
//   float sun_behind_terrain(float t_km, float altitude_km)       share of the sun's disc seen from there, 0 ... 1
//
//   L(d) = E_sun * integral from 0 to d of T(0, t) [ (beta_R rho_R P_R + beta_M rho_M P_M) T(t, sun) V(t) + S(t) ] dt
// S: chapter 09's source: light that was scattered before and is scattered again, towards the eye. V: the share of the
// sun that the terrain leaves visible; light of higher orders comes from all around and is not shadowed.
#ifndef WELKIN_AERIAL_GLSL
#define WELKIN_AERIAL_GLSL

#include "09_multiple_scattering_lut/multiple_scattering.glsl"

// Transmittance from a point towards the sun; 0 where the planet is in the way. air: the method's (see MethodAir).
vec3 sun_through_air(Atmosphere air, float altitude_km, float mu_sun) {
  if (!sun_above_horizon(air.ground_radius_km, altitude_km, mu_sun)) return vec3(0.0, 0.0, 0.0);
  return exp(extinction(air, sun_columns(air, altitude_km, mu_sun)) * -1.0);
}

// Air between the eye and a point: the light it adds, and its optical depth.
struct AirSegment {
  vec3 radiance;
  vec3 depth;
};

AirSegment no_air() {
  AirSegment segment;
  segment.radiance = vec3(0.0, 0.0, 0.0);
  segment.depth = vec3(0.0, 0.0, 0.0);
  return segment;
}

// [air_segment]
// Adds the air from t_a to t_b behind `before`. One node in the middle, or pairs of Gauss-Legendre nodes; each stands
// for a piece of constant source and extinction. The pieces tile the segment, so that nothing is left out at its end.
AirSegment append_segment(MethodAir method, AirRay ray, ScatteringTowardsEye scattering, AirSegment before, float t_a,
                          float t_b, int samples) {
  Atmosphere air = method.air;
  AirSegment segment = before;
  // [air_pieces]
  float dt = (t_b - t_a) / float(samples);
  for (int i = 0; i < samples; i++) {
    float offset = samples == 1 ? 0.5 : (i % 2 == 0 ? 0.42264973081037424 : 0.57735026918962576);
    CountedPoint point;
    point.t_km = t_a + (float(i) + offset) * dt;
    point.altitude_km = max(altitude_along(air.ground_radius_km, ray.altitude_km, ray.mu, point.t_km), 0.0);
    point.s_km = (air.ground_radius_km + ray.altitude_km) * ray.mu + point.t_km;
    point.dt_dx = 1.0;
    if (point.altitude_km <= air.top_km) {
      vec3 density = densities(air, point.altitude_km);
      vec3 tau = extinction(air, density) * dt;
      float mu_sun = mu_sun_along(ray, air.ground_radius_km, point.t_km, point.altitude_km);
      vec3 source = (scattering.rayleigh * density.x + scattering.mie * density.y) *
                    sun_through_air(air, point.altitude_km, mu_sun) * sun_behind_terrain(point.t_km, point.altitude_km);
      if (HIGHER_ORDERS) source += source_at(air, ray, point, density, method.chi);
      vec3 mean = vec3(mean_transmittance(tau.x), mean_transmittance(tau.y), mean_transmittance(tau.z));
      segment.radiance += exp(segment.depth * -1.0) * source * mean * dt;
      segment.depth += tau;
    }
  }
  return segment;
  // [/air_pieces]
}
// [/air_segment]

// [slices]
// Distance of the far end of the first s of n slices, d = d_max (s / n)^power; and how many slices lie before a
// distance.
float slice_end(float s, float slices, float farthest_km, float power) { return farthest_km * pow(s / slices, power); }
float slices_before(float t_km, float slices, float farthest_km, float power) {
  return slices * pow(clamp(t_km / farthest_km, 0.0, 1.0), 1.0 / power);
}
// [/slices]

// [froxel]
// What a froxel keeps of the air up to its far end, at distance d: not L and T, which change by large factors from one
// slice to the next, but what the air would be if it were homogeneous up to there,
//   extinction = tau / d,  in_scattering = L / (1 - T),  so that  T = exp(-extinction d),  L = in_scattering (1 - T).
// Both hardly change with d; at the eye they are those of the air there. 1 - T = tau phi(tau), phi the mean
// transmittance.
// [froxel_kept]
struct Froxel {
  vec3 in_scattering;
  vec3 extinction;  // per km
};

vec3 opacity(vec3 tau) {
  return vec3(tau.x * mean_transmittance(tau.x), tau.y * mean_transmittance(tau.y), tau.z * mean_transmittance(tau.z));
}

Froxel froxel_of(AirSegment segment, float d_km) {
  Froxel froxel;
  froxel.in_scattering = segment.radiance / max(opacity(segment.depth), vec3(1.0e-30, 1.0e-30, 1.0e-30));
  froxel.extinction = segment.depth / d_km;
  return froxel;
}

RayLight light_before(Froxel froxel, float d_km) {
  vec3 tau = froxel.extinction * d_km;
  RayLight light;
  light.radiance = froxel.in_scattering * opacity(tau);
  light.transmittance = exp(tau * -1.0);
  return light;
}
// [/froxel_kept]
// [/froxel]

// [march_to]
// All the air up to distance d: the same slices, laid so that the last ends there.
RayLight march_to(MethodAir method, AirRay ray, ScatteringTowardsEye scattering, float d_km, int slices, int samples,
                  float power) {
  AirSegment segment = no_air();
  float t_a = 0.0;
  for (int k = 0; k < slices; k++) {
    float t_b = slice_end(float(k + 1), float(slices), d_km, power);
    segment = append_segment(method, ray, scattering, segment, t_a, t_b, samples);
    t_a = t_b;
  }
  RayLight light;
  light.radiance = segment.radiance;
  light.transmittance = exp(segment.depth * -1.0);
  return light;
}
// [/march_to]

// What scatters towards the eye along a ray. The phase functions' angles are the same all along it.
ScatteringTowardsEye scattering_along(Atmosphere atmosphere, vec3 view, vec3 sun) {
  return scattering_towards_eye(atmosphere, one_minus_cosine(view, sun), one_minus_cosine(view, sun * -1.0));
}

#endif
