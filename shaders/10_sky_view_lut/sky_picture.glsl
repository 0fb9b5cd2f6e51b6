// Draws the sky with one look-up per pixel and, with SUN_DISC defined, the sun's disc seen through the air. A scene
// without the disc compiles none of its code.
#ifndef WELKIN_SKY_PICTURE_GLSL
#define WELKIN_SKY_PICTURE_GLSL

layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "04_air/variant.glsl"
#include "04_air/medium.glsl"
#ifdef SUN_DISC
#define TRANSMITTANCE_BINDING 2
#include "08_transmittance_lut/table.glsl"
#define SUN_OPTICAL_DEPTH optical_depth_to_top
#include "05_single_scattering/sun_disc.glsl"
#endif
layout(constant_id = 6) const float SKY_VIEW_UNIT = 1.0;
#define SKY_VIEW_BINDING 1
#include "10_sky_view_lut/sky_view.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
layout(binding = 3, rgba32f) uniform writeonly image2D target;

// [sky]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const vec3 view = camera_direction(frame.camera, pixel);
  vec3 radiance = sky_view_radiance(atmosphere.ground_radius_km, frame.camera.altitude_km, view, frame.camera.sun);
#ifdef SUN_DISC
  // The disc is too small for any table: it is drawn, attenuated by chapter 08's transmittance table.
  radiance += sun_disc_light(atmosphere, frame.camera, pixel, view);
#endif
  imageStore(target, pixel, vec4(radiance, 1.0));
}
// [/sky]

#endif
