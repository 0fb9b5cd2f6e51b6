// Looks up optical depth and transmittance to the top of the air. Pure functions; km. The including file defines
//   vec3 read_transmittance_table(vec2 uv)      the table, filtered linearly
//   ivec2 transmittance_table_size()
// A downward path passes its lowest point, at altitude h_p. By symmetry
//   tau(h, -mu) = 2 tau(h_p, 0) - tau(h, mu),
// so the folded table holds no downward rays and no horizon, at which it would have to change abruptly.
#ifndef WELKIN_TRANSMITTANCE_LUT_GLSL
#define WELKIN_TRANSMITTANCE_LUT_GLSL

#include "08_transmittance_lut/table_map.glsl"

// [look_up]
// Optical depth of a path that the table holds, decoded from any of the three stored forms.
vec3 stored_optical_depth(Atmosphere atmosphere, float altitude_km, float mu) {
  vec3 stored = read_transmittance_table(transmittance_uv(atmosphere, altitude_km, mu, transmittance_table_size()));
  if (TABLE_STORED == kStoredMeanExtinction)
    return stored * distance_to_shell_from_inside(atmosphere.ground_radius_km, altitude_km, mu, atmosphere.top_km);
  if (TABLE_STORED == kStoredOpticalDepth) return stored;
  return log(max(stored, vec3(1.0e-37, 1.0e-37, 1.0e-37))) * -1.0;
}

// Optical depth to the top along a path that misses the ground. A lowest point below the ground is treated as rounding
// error and clamped to the ground. sine = sqrt(1 - mu^2).
vec3 optical_depth_to_top(Atmosphere atmosphere, float altitude_km, float mu) {
  if (TABLE_MAPPING == kMappingPublished) return stored_optical_depth(atmosphere, altitude_km, mu);
  vec3 upward = stored_optical_depth(atmosphere, altitude_km, abs(mu));
  if (mu >= 0.0) return upward;
  float sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  float lowest_km = clamp(tangent_altitude(atmosphere.ground_radius_km, altitude_km, mu, sine), 0.0, altitude_km);
  return max(stored_optical_depth(atmosphere, lowest_km, 0.0) * 2.0 - upward, vec3(0.0, 0.0, 0.0));
}

// Transmittance from altitude h (0 ... top) to the top of the air; 0 where the ground blocks the path.
vec3 transmittance_to_top(Atmosphere atmosphere, float altitude_km, float mu) {
  if (mu < 0.0 && tangent_altitude(atmosphere.ground_radius_km, altitude_km, mu,
                                   sqrt(max((1.0 - mu) * (1.0 + mu), 0.0))) < 0.0)
    return vec3(0.0, 0.0, 0.0);
  return exp(optical_depth_to_top(atmosphere, altitude_km, mu) * -1.0);
}
// [/look_up]

#endif
