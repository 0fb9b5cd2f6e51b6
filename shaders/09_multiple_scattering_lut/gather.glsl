// Light that a node of a ray scatters, or the ground at its end reflects, towards the ray's first point: sunlight for
// the first order, light of the table for higher orders. Pure functions; km, radiance per unit of solar irradiance.
#ifndef WELKIN_GATHER_GLSL
#define WELKIN_GATHER_GLSL

#include "05_single_scattering/single_scattering.glsl"
#include "09_multiple_scattering_lut/directions.glsl"
#include "09_multiple_scattering_lut/ray_nodes.glsl"

// The air that a method marches, delta scaled for the method of moments, and the aerosol's moments chi_1, chi_2 in it.
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
  float fraction = forward_fraction(chi);
  result.air = delta_scaled_air(atmosphere, fraction);
  result.chi = delta_scaled_moments(chi, fraction);
  return result;
}

// Unit vector towards the sun: z up, x horizontal towards the sun.
vec3 sun_direction_from(float mu_sun) {
  return vec3(sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 0.0)), 0.0, mu_sun);
}

// [published]
// Psi = L2 / (1 - f). f reaches 1 where nothing is absorbed and nothing escapes. The limit 0.999 is worth a thousand
// orders and keeps the quotient finite when quadrature error takes f past 1. L2 and f are the integrals of Hillaire
// 2020, equations 5 and 7: sums of sunlight_scattered_at_node() and transfer_at_node() over the nodes of all
// directions.
vec3 sum_geometric_series(vec3 second, vec3 transfer) {
  return second / (vec3(1.0, 1.0, 1.0) - clamp(transfer, vec3(0.0, 0.0, 0.0), vec3(0.999, 0.999, 0.999)));
}

vec3 transfer_at_node(RayNode node) { return vec3(node.rayleigh) + vec3(node.mie); }
// [/published]

// [first_order]
// Phase functions (rayleigh, mie) of the first order: the first two moments of the true ones for the method of moments,
// isotropic for the other methods. nu: cosine between ray and sun.
vec2 first_order_phases(vec2 chi, float nu) {
  vec2 phases = vec2(0.079577471545947668, 0.079577471545947668);
  if (MS_METHOD != kMethodMoments) return phases;
  return phases * two_moment_phases(chi, nu);
}

// Sunlight scattered at a node, and sunlight that the ground at the ray's end reflects. mu_sun, nu: at the ray's first
// point.
vec3 sunlight_scattered_at_node(Atmosphere air, RayNode node, vec2 phases, float mu_sun, float nu) {
  float node_mu_sun = cosine_at_node(node, mu_sun, nu);
  if (!sun_above_horizon(air.ground_radius_km, node.geometry.x, node_mu_sun)) return vec3(0.0, 0.0, 0.0);
  vec3 scattered = vec3(node.rayleigh) * phases.x + vec3(node.mie) * phases.y;
  return scattered * exp(-extinction(air, sun_columns(air, node.geometry.x, node_mu_sun)));
}

vec3 sunlight_reflected_at_end(Atmosphere air, RayNode end, float mu_sun, float nu) {
  return vec3(end.rayleigh) * lit_ground(air, cosine_at_node(end, mu_sun, nu), 1, kRuleAdapted);
}
// [/first_order]

// [next_order]
// The same for light of the table. mu, mu_sun, nu: at the ray's first point.
vec3 table_light_scattered_at_node(Atmosphere air, RayNode node, vec2 chi, float mu, float mu_sun, float nu) {
  float node_mu_sun = cosine_at_node(node, mu_sun, nu);
  if (MS_METHOD != kMethodMoments)
    return multiple_scattering(air, node.geometry.x, node_mu_sun) * transfer_at_node(node);
  float node_mu = cosine_at_node(node, mu, 1.0);
  return scattered_towards_eye(vec3(node.rayleigh), vec3(node.mie),
                               multiple_scattering_moments(air, node.geometry.x, node_mu_sun), chi,
                               view_x_from(nu, node_mu_sun, node_mu), node_mu);
}

vec3 table_light_reflected_at_end(Atmosphere air, RayNode end, float mu_sun, float nu) {
  return vec3(end.rayleigh) * sky_irradiance(air, 0.0, cosine_at_node(end, mu_sun, nu)) * 0.31830988618379067;
}
// [/next_order]

#endif
