// What every entry point that reads the sky view table includes. It says first where the table is bound:
//   #define SKY_VIEW_BINDING n
// and declares const float SKY_VIEW_UNIT, what a stored 1 is worth (1, or 1/4096 in the table of halves).
#ifndef WELKIN_SKY_VIEW_GLSL
#define WELKIN_SKY_VIEW_GLSL

#include "10_sky_view_lut/sky_view_map.glsl"

layout(binding = SKY_VIEW_BINDING) uniform sampler2D sky_view_table;

// [look]
// Radiance of the sky, or of the ground and the air before it, towards `view`; sun and view in the local frame, z up.
vec3 sky_view_radiance(float ground_radius_km, float altitude_km, vec3 view, vec3 sun) {
  const SkyViewPlace place = sky_view_place(horizon_at(ground_radius_km, altitude_km), view, sun);
  return textureLod(sky_view_table, sky_view_uv(place, textureSize(sky_view_table, 0)), 0.0).rgb * SKY_VIEW_UNIT;
}
// [/look]

#endif
