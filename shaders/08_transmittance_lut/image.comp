// One camera ray per pixel through single_scattering() with the table, and the sun's disc behind the air.
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
  // A copy: loops then keep the numbers at hand instead of reading the uniform block at every sample.
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(frame.camera, pixel);
  const vec3 sun = frame.camera.sun;
  const float altitude_km = frame.camera.altitude_km;

  // Only the sun's disc is seen through the air and needs the transmittance: a few pixels of the picture.
  const vec3 disc = SUN_DISC ? sun_disc_radiance(air.solar_irradiance, air.sun_angular_radius, one_minus_cosine(view, sun)) : vec3(0.0);
  const bool on_disc = SUN_DISC && disc.g > 0.0;
  const RayLight sky = scattered_light(air, altitude_km, view, sun, steps.x, NO_LIGHT_STEPS, RULE, on_disc);
  vec3 radiance = sky.radiance;
  if (on_disc && !enter_air(air, altitude_km, view, sun).hits_ground) radiance += sky.transmittance * disc;
  imageStore(target, pixel, vec4(radiance, 1.0));
}
// [/image]
