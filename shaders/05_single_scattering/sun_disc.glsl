// The sun's disc behind the air, darker towards the limb. Pure functions; radians, km.
//
//   L(mu_s) = E / (pi sin^2 a) * (alpha + 2)/2 * mu_s^alpha       mu_s = sqrt(1 - (sin angle / sin a)^2)
// a is the disc's angular radius, mu_s the cosine at the sun's surface. The factor (alpha + 2)/2 makes the disc's mean
// E / (pi sin^2 a), so that the disc as a whole sends exactly the irradiance E. Exponents alpha of a power law fitted
// to the sun's limb at 680, 550, 440 nm: Hestroffer and Magnan 1998, Astron. Astrophys. 333, 338.
#ifndef WELKIN_SUN_DISC_GLSL
#define WELKIN_SUN_DISC_GLSL

#include "04_air/sun_in_pixel.glsl"
#include "05_single_scattering/march.glsl"

// [limb]
// Radiance per channel of the disc before the air. Domain: irradiance >= 0, 0 < angular_radius <= 0.2, mu in 0 ... 1.
vec3 sun_disc_radiance(vec3 irradiance, float angular_radius, float mu) {
  vec3 alpha = vec3(0.397, 0.503, 0.652);
  vec3 darkening = vec3(pow(mu, alpha.x), pow(mu, alpha.y), pow(mu, alpha.z)) * (alpha + vec3(2.0, 2.0, 2.0)) * 0.5;
  return irradiance * darkening / (3.14159265358979324 * sine_squared(angular_radius));
}
// [/limb]

// [disc_light]
// The disc's mean radiance over a pixel: each piece through the air in its direction, and only what stands above the
// horizon. view: camera_direction() of that pixel.
vec3 sun_disc_light(Atmosphere atmosphere, CameraRays camera, ivec2 pixel, vec3 view) {
  vec3 light = vec3(0.0, 0.0, 0.0);
  SunInPixel disc = sun_in_pixel(camera, pixel, view, atmosphere.sun_angular_radius);
  if (disc.side == 0) return light;
  vec2 horizon = horizon_at(atmosphere.ground_radius_km, camera.altitude_km);
  for (int i = 0; i < disc.side; i++) {
    SunRow row = sun_row(disc, i);
    for (int j = 0; j < disc.side; j++) {
      SunNode node = sun_node(disc, row, horizon, j);
      vec3 radiance = sun_disc_radiance(atmosphere.solar_irradiance, atmosphere.sun_angular_radius, node.mu);
      AirRay ray = enter_air(atmosphere, camera.altitude_km, node.view, camera.sun);
      if (ray.hits_air)
        radiance *= exp(optical_depth_and_to_sun(atmosphere, vec3(0.0, 0.0, 0.0), ray.altitude_km, ray.mu) * -1.0);
      light += radiance * node.share;
    }
  }
  return light;
}
// [/disc_light]

#endif
