// Traces one camera ray per pixel through single_scattering() with the table, and adds the sun's disc seen through the
// air.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "08_transmittance_lut/sky.glsl"

layout(binding = 2, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  ivec4 steps;  // x: view
};

// [image]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  // Copied so that loops keep the values in registers instead of reading the uniform block at every sample.
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(frame.camera, pixel);
  vec3 radiance = scattered_light(air, frame.camera.altitude_km, view, frame.camera.sun, steps.x, UNUSED_LIGHT_STEPS,
                                  RULE, false).radiance;
  if (SUN_DISC) radiance += sun_disc_light(air, frame.camera, pixel, view);
  imageStore(target, pixel, vec4(radiance, 1.0));
}
// [/image]
