// Traces one camera ray per pixel through all_orders_light() and adds the sun's disc seen through the air.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
layout(binding = 1) uniform sampler2D table;
vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(table, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"
#include "05_single_scattering/sun_disc.glsl"

layout(constant_id = 7) const bool SUN_DISC = true;
layout(binding = 2, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  ivec4 steps;  // x: first order, y: table
};

// [image]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(frame.camera, pixel);
  vec3 radiance =
      all_orders_light(air, frame.camera.altitude_km, view, frame.camera.sun, steps.x, steps.y, false).radiance;
  if (SUN_DISC) radiance += sun_disc_light(air, frame.camera, pixel, view);
  imageStore(target, pixel, vec4(radiance, 1.0));
}
// [/image]
