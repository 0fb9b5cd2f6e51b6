// Transmittance to the top of the air, looked up. Pure functions; km. The including file gives
//   vec3 read_transmittance_table(vec2 uv)      what is stored there, linear between texels
//   ivec2 transmittance_table_size()
// A path that dips passes its lowest point h_p, and by symmetry
//   tau(h, -mu) = 2 tau(h_p, 0) - tau(h, mu):
// the folded table needs no downward rays, and so has no horizon inside or beside it.
#ifndef WELKIN_TRANSMITTANCE_LUT_GLSL
#define WELKIN_TRANSMITTANCE_LUT_GLSL

#include "08_transmittance_lut/table_map.glsl"

// [look_up]
// Optical depth stored for a path, whatever the table holds.
vec3 stored_optical_depth(Atmosphere atmosphere, float altitude_km, float mu) {
  vec3 stored = read_transmittance_table(transmittance_uv(atmosphere, altitude_km, mu, transmittance_table_size()));
  if (TABLE_STORED == kStoredMeanExtinction) return stored * distance_to_shell_from_inside(atmosphere.ground_radius_km, altitude_km, mu, atmosphere.top_km);
  if (TABLE_STORED == kStoredOpticalDepth) return stored;
  return log(max(stored, vec3(1.0e-37, 1.0e-37, 1.0e-37))) * -1.0;
}

// Optical depth to the top along a path that the ground does not stop: a lowest point below it is taken for rounding and
// counts as touching. sine = sqrt(1 - mu^2).
vec3 clear_optical_depth(Atmosphere atmosphere, float altitude_km, float mu) {
  if (TABLE_MAPPING == kMappingPublished) return stored_optical_depth(atmosphere, altitude_km, mu);
  vec3 upward = stored_optical_depth(atmosphere, altitude_km, abs(mu));
  if (mu >= 0.0) return upward;
  float sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
  float lowest_km = clamp(tangent_altitude(atmosphere.ground_radius_km, altitude_km, mu, sine), 0.0, altitude_km);
  return max(stored_optical_depth(atmosphere, lowest_km, 0.0) * 2.0 - upward, vec3(0.0, 0.0, 0.0));
}

// Transmittance from altitude h in the air (0 ... top) to the top; 0 where the ground is in the way.
vec3 transmittance_to_top(Atmosphere atmosphere, float altitude_km, float mu) {
  if (mu < 0.0 && tangent_altitude(atmosphere.ground_radius_km, altitude_km, mu, sqrt(max((1.0 - mu) * (1.0 + mu), 0.0))) < 0.0) return vec3(0.0, 0.0, 0.0);
  return exp(clear_optical_depth(atmosphere, altitude_km, mu) * -1.0);
}
// [/look_up]

#endif
