// Included by every entry point that reads the sky view table. The entry point first defines where the table is bound,
//   #define SKY_VIEW_BINDING n
// and declares const float SKY_VIEW_UNIT, the radiance of a stored 1: 1, or 1/4096 in the table of 16-bit floats.
#ifndef WELKIN_SKY_VIEW_GLSL
#define WELKIN_SKY_VIEW_GLSL

#include "10_sky_view_lut/sky_view_map.glsl"

layout(binding = SKY_VIEW_BINDING) uniform sampler2D sky_view_table;

// [look]
// Radiance of the sky, or of the ground and the air in front of it, in direction `view`. view, sun: unit vectors in the
// local frame, z up.
vec3 sky_view_radiance(float ground_radius_km, float altitude_km, vec3 view, vec3 sun) {
  const SkyViewCoordinates coordinates = sky_view_coordinates(horizon_at(ground_radius_km, altitude_km), view, sun);
  return textureLod(sky_view_table, sky_view_uv(coordinates, textureSize(sky_view_table, 0)), 0.0).rgb * SKY_VIEW_UNIT;
}
// [/look]

#endif
