// One camera ray per pixel through single_scattering(), and the sun's disc behind the air.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/camera.h"
#include "03_planet_and_rays/camera.glsl"
#include "05_single_scattering/sky.glsl"

layout(binding = 1, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  CameraRays camera;
  ivec4 steps;  // x: view
};

// [image]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size))) return;
  // A copy, so that loops keep the numbers in registers instead of reading the uniform block at every sample.
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(camera, pixel);
  vec3 radiance =
      scattered_light(air, camera.altitude_km, view, camera.sun, steps.x, LIGHT_STEPS, RULE, false).radiance;
  if (SUN_DISC) radiance += sun_disc_light(air, camera, pixel, view);
  imageStore(target, pixel, vec4(radiance, 1.0));
}
// [/image]
