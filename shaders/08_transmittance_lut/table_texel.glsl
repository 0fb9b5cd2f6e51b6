// Computes the content of one texel of the transmittance table. Pure functions; km.
#ifndef WELKIN_TABLE_TEXEL_GLSL
#define WELKIN_TABLE_TEXEL_GLSL

#include "05_single_scattering/march.glsl"
#include "08_transmittance_lut/table_map.glsl"

// [table_columns]
// Columns (rayleigh, mie, ozone) from altitude h to the top. steps > 0: panels of four Gauss-Legendre points, for any
// density profile. steps = 0: the closed form of chapter 05, for exponential and tent profiles.
vec3 table_columns(Atmosphere atmosphere, float altitude_km, float mu, int steps) {
  if (steps == 0) return sun_columns(atmosphere, altitude_km, mu);
  float radius_km = atmosphere.ground_radius_km;
  float d = distance_to_shell_from_inside(radius_km, altitude_km, mu, atmosphere.top_km);
  vec3 column = vec3(0.0, 0.0, 0.0);
  for (int i = 0; i < steps; i++) {
    Segment segment = quadrature_segment(kRuleGaussLegendre, i, steps);
    float h = altitude_along(radius_km, altitude_km, mu, segment.sample_at * d);
    column += densities(atmosphere, max(h, 0.0)) * (segment.width * d);
  }
  return column;
}
// [/table_columns]

// [table_texel]
// The texel at `uv` of a table of `size` texels.
vec3 table_texel(Atmosphere atmosphere, vec2 uv, ivec2 size, int steps) {
  TablePath path = transmittance_path(atmosphere, uv, size);
  vec3 tau = extinction(atmosphere, table_columns(atmosphere, path.altitude_km, path.mu, steps));
  if (TABLE_STORED == kStoredMeanExtinction) {
    // At the top the path has no length. For a path shorter than 1 km the mean is the extinction at its midpoint.
    float d = distance_to_shell_from_inside(atmosphere.ground_radius_km, path.altitude_km, path.mu, atmosphere.top_km);
    if (d < 1.0) return extinction(atmosphere, densities(atmosphere, 0.5 * (path.altitude_km + atmosphere.top_km)));
    return tau / d;
  }
  if (TABLE_STORED == kStoredOpticalDepth) return tau;
  return exp(tau * -1.0);
}
// [/table_texel]

#endif
