// Copies the drawn sky into the target and puts the sun's disc into it, dimmed by the air it shines through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/variant.glsl"
layout(constant_id = 4) const int PHASE_DETAIL = 3;
layout(constant_id = 5) const bool SUN_DISC = true;
#include "04_air/constant_sky.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "04_air/sun_in_pixel.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform Air { Atmosphere atmosphere; };
layout(binding = 1, rgba32f) uniform readonly image2D sky;
layout(binding = 2, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push { CameraRays camera; };

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size))) return;
  vec3 radiance = imageLoad(sky, pixel).xyz;
  // [disc]
  if (SUN_DISC) {
    // Radiance of a disc that is equally bright everywhere: irradiance / (pi sin^2 a).
    const vec3 bright =
        atmosphere.solar_irradiance / (3.14159265358979324 * sine_squared(atmosphere.sun_angular_radius));
    const vec2 horizon = horizon_at(atmosphere.ground_radius_km, camera.altitude_km);
    const SunInPixel disc = sun_in_pixel(camera, pixel, camera_direction(camera, pixel), atmosphere.sun_angular_radius);
    for (int i = 0; i < disc.side; ++i) {
      const SunRow row = sun_row(disc, i);
      for (int j = 0; j < disc.side; ++j) {
        const SunNode node = sun_node(disc, row, horizon, j);
        radiance +=
            bright * node.share * constant_sky(atmosphere, camera.altitude_km, node.view, camera.sun).transmittance;
      }
    }
  }
  // [/disc]
  imageStore(target, pixel, vec4(radiance, 1.0));
}
