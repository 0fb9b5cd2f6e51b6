// The sun's disc in single pixels, for tests/gpu/05_sun_disc_test.cpp. In, 20 floats an item: right, up, forward, sun (three
// each), altitude in km, width, height, pixel x, y, angular radius of the disc, three unused. Out, six: mean radiance over the
// pixel behind the Earth's air; then that of the disc before the air at the pixel's middle, as a renderer draws it first.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "interop/camera.h"
#include "03_planet_and_rays/camera.glsl"
#include "04_air/variant.glsl"
#include "05_single_scattering/sun_disc.glsl"
#include "../tests/gpu/shaders/atmosphere_of.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  float inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

vec3 three(uint at) { return vec3(inputs[at], inputs[at + 1u], inputs[at + 2u]); }

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint k = 20u * item;
  CameraRays camera;
  camera.right = three(k);
  camera.up = three(k + 3u);
  camera.forward = three(k + 6u);
  camera.sun = three(k + 9u);
  camera.altitude_km = inputs[k + 12u];
  camera.size = ivec2(inputs[k + 13u], inputs[k + 14u]);
  const ivec2 pixel = ivec2(inputs[k + 15u], inputs[k + 16u]);
  const float radius = inputs[k + 17u];
  const Atmosphere earth = atmosphere_of(vec4(5.802e-3, 13.558e-3, 33.1e-3, 8.0), vec4(vec3(3.996e-3), 1.2), vec4(vec3(4.440e-3), 0.8),
                                         vec4(0.650e-3, 1.881e-3, 0.085e-3, 25.0), vec4(6360.0, 100.0, 15.0, radius), vec4(0.0), vec4(1.0, 1.0, 1.0, 0.0));
  const vec3 view = camera_direction(camera, pixel);
  const vec3 light = sun_disc_light(earth, camera, pixel, view);
  const float one_minus_nu = one_minus_cosine(view, camera.sun);
  const float from_limb2 = 1.0 - one_minus_nu * (2.0 - one_minus_nu) / sine_squared(radius);
  const vec3 middle = one_minus_nu < 1.0 && from_limb2 > 0.0 ? sun_disc_radiance(vec3(1.0), radius, sqrt(from_limb2)) : vec3(0.0);
  for (int i = 0; i < 3; ++i) {
    outputs[6u * item + i] = light[i];
    outputs[6u * item + 3u + i] = middle[i];
  }
}
