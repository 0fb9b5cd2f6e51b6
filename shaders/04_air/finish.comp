// Copies the drawn sky into the target and puts the sun's disc into it, dimmed by the air it shines through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/variant.glsl"
layout(constant_id = 4) const int PHASE_DETAIL = 3;
layout(constant_id = 5) const bool SUN_DISC = true;
#include "04_air/constant_sky.glsl"
#include "03_planet_and_rays/camera.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform Air { Atmosphere atmosphere; };
layout(binding = 1, rgba32f) uniform readonly image2D sky;
layout(binding = 2, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push { CameraRays camera; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size))) return;
  vec3 radiance = imageLoad(sky, pixel).xyz;
  if (SUN_DISC) {
    // Inside the disc of angular radius a: 1 - cos < 1 - cos a = 2 sin^2(a/2); its solid angle is 4 pi sin^2(a/2).
    const float half_sine = sin(0.5 * atmosphere.sun_angular_radius);
    const vec3 view = camera_direction(camera, pixel);
    if (one_minus_cosine(view, camera.sun) < 2.0 * half_sine * half_sine) {
      const ConstantSky path = constant_sky(atmosphere, camera.altitude_km, view, camera.sun);
      radiance += (1.0 - path.hits_ground) * path.transmittance * atmosphere.solar_irradiance * (0.0795774715 / (half_sine * half_sine));
    }
  }
  imageStore(target, pixel, vec4(radiance, 1.0));
}
