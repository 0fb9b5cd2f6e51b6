// What a node of a ray brings to its first point: the first order from the sun, further ones from a table of the orders before.
// Pure functions; km, radiance per unit of solar irradiance.
#ifndef WELKIN_GATHER_GLSL
#define WELKIN_GATHER_GLSL

#include "05_single_scattering/single_scattering.glsl"
#include "09_multiple_scattering_lut/directions.glsl"
#include "09_multiple_scattering_lut/ray_nodes.glsl"

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
// Psi = L2 / (1 - f). f reaches 1 where nothing is absorbed and nothing escapes: 0.999 stands for a thousand orders, and
// keeps the quotient finite when quadrature takes f past 1. L2 and f sum sun_at_node() and transfer_at_node() over the
// nodes of all directions: the integrals of Hillaire 2020, equations 5 and 7.
vec3 close_series(vec3 second, vec3 transfer) {
  return second / (vec3(1.0, 1.0, 1.0) - clamp(transfer, vec3(0.0, 0.0, 0.0), vec3(0.999, 0.999, 0.999)));
}

vec3 transfer_at_node(RayNode node) { return vec3(node.molecules) + vec3(node.aerosol); }
// [/published]

// [first_order]
// Phase functions of the first order, for a ray at cosine nu to the sun: (molecules, aerosol). Those that the method has
// moments for; isotropic ones otherwise.
vec2 beam_phases(vec2 chi, float nu) {
  vec2 phases = vec2(0.079577471545947668, 0.079577471545947668);
  if (MS_METHOD != kMethodMoments) return phases;
  return phases * broad_phases(chi, nu);
}

// Sunlight scattered at a node, and sunlight that the ground at the ray's end returns. mu_sun, nu: of the ray's first point.
vec3 sun_at_node(Atmosphere air, RayNode node, vec2 phases, float mu_sun, float nu) {
  float mu = turned_cosine(node, mu_sun, nu);
  if (!sun_above_horizon(air.ground_radius_km, node.place.x, mu)) return vec3(0.0, 0.0, 0.0);
  vec3 scattered = vec3(node.molecules) * phases.x + vec3(node.aerosol) * phases.y;
  return scattered * exp(-extinction(air, sun_columns(air, node.place.x, mu)));
}

vec3 sun_at_end(Atmosphere air, RayNode end, float mu_sun, float nu) {
  return vec3(end.molecules) * lit_ground(air, turned_cosine(end, mu_sun, nu), 1, kRuleAdapted);
}
// [/first_order]

// [next_order]
// The same for light of the table, in place of the sun's.
vec3 table_at_node(Atmosphere air, RayNode node, vec2 chi, float look_z, float mu_sun, float nu) {
  float mu = turned_cosine(node, mu_sun, nu);
  if (MS_METHOD != kMethodMoments) return multiple_scattering(air, node.place.x, mu) * transfer_at_node(node);
  float look = turned_cosine(node, look_z, 1.0);
  return scattered_towards_eye(vec3(node.molecules), vec3(node.aerosol), multiple_scattering_moments(air, node.place.x, mu), chi,
                               look_x_from(nu, mu, look), look);
}

vec3 table_at_end(Atmosphere air, RayNode end, float mu_sun, float nu) {
  return vec3(end.molecules) * sky_irradiance(air, 0.0, turned_cosine(end, mu_sun, nu)) * 0.31830988618379067;
}
// [/next_order]

#endif
