// Fills the sky view table: one direct march of chapter 09 per texel, for the camera's altitude and the sun's height. The
// including entry point declares the image, writeonly and named `sky_view`, and SKY_VIEW_UNIT: what a stored 1 is worth;
// with SINGLE_ORDER defined the march is chapter 05's, and there is no scattering table.
#ifndef WELKIN_FILL_SKY_VIEW_GLSL
#define WELKIN_FILL_SKY_VIEW_GLSL

#ifdef SINGLE_ORDER
#include "04_air/variant.glsl"
#include "05_single_scattering/single_scattering.glsl"
layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
#else
layout(binding = 1) uniform sampler2D scattering_table;
vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(scattering_table, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"
#endif
#include "10_sky_view_lut/sky_view_map.glsl"

layout(push_constant) uniform Push {
  vec4 place;   // x: altitude in km; y, z: cosine and sine of the sun's zenith angle
  ivec4 steps;  // x: first order, y: table
};

// [fill]
void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 size = imageSize(sky_view);
  if (any(greaterThanEqual(texel, size))) return;
  const Atmosphere air = atmosphere;
  const SkyViewPlace at = sky_view_texel(texel, size);
  const vec2 zenith = sky_view_zenith(horizon_at(air.shape.x, place.x), at.from_horizon, at.below);
  const vec3 view = vec3(sky_view_azimuth(at.across) * zenith.y, zenith.x);
  const vec3 sun = vec3(place.z, 0.0, place.y);
#ifdef SINGLE_ORDER
  const RayLight light = scattered_light(air, place.x, view, sun, steps.x, 1, kRuleAdapted, false);
#else
  const RayLight light = all_orders_light(air, place.x, view, sun, steps.x, steps.y, false);
#endif
  imageStore(sky_view, texel, vec4(min(light.radiance / SKY_VIEW_UNIT, vec3(65504.0)), 1.0));
}
// [/fill]

#endif
