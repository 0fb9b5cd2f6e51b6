// The sun's disc: its radiance before the air, darker towards the limb. Pure functions; radians.
//
//   L(mu_s) = E / (pi sin^2 a) * (alpha + 2)/2 * mu_s^alpha       mu_s = sqrt(1 - (sin angle / sin a)^2)
// a is the disc's angular radius, mu_s the cosine at the sun's surface. The factor (alpha + 2)/2 makes the disc's mean
// E / (pi sin^2 a), so that the disc as a whole sends exactly the irradiance E. Exponents alpha of a power law fitted to the
// sun's limb at 680, 550, 440 nm: Hestroffer and Magnan 1998, Astron. Astrophys. 333, 338.
#ifndef WELKIN_SUN_DISC_GLSL
#define WELKIN_SUN_DISC_GLSL

// Radiance per channel towards a direction at 1 - cosine `one_minus_nu` from the disc's centre; 0 outside the disc.
// Domain: irradiance >= 0, 0 < angular_radius <= 0.2 rad.
vec3 sun_disc_radiance(vec3 irradiance, float angular_radius, float one_minus_nu) {
  // sin^2 as a series (next term 3e-3 a^8): Vulkan lets sin() be wrong by 5e-4 in absolute terms, and a real GPU's is off
  // by 1e-4 of so small an angle, which shows at the limb.
  float a2 = angular_radius * angular_radius;
  float sine2_radius = a2 * (1.0 - a2 * (0.33333333333333333 - a2 * 0.044444444444444444));
  float sine2 = one_minus_nu * (2.0 - one_minus_nu);  // 1 - nu^2 without cancelling
  if (one_minus_nu > 1.0 || sine2 >= sine2_radius) return vec3(0.0, 0.0, 0.0);
  float mu = sqrt(1.0 - sine2 / sine2_radius);
  vec3 alpha = vec3(0.397, 0.503, 0.652);
  vec3 darkening = vec3(pow(mu, alpha.x), pow(mu, alpha.y), pow(mu, alpha.z)) * (alpha + vec3(2.0, 2.0, 2.0)) * 0.5;
  return irradiance * darkening / (3.14159265358979324 * sine2_radius);
}

#endif
