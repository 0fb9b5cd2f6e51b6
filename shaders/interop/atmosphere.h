// What the air, the ground and the sun are made of, as the shaders see them. Included by C++ and by GLSL.
//
// Units: km, 1/km, radians. std140: a vec3 and a float after it share 16 bytes, so the layout is the same on both
// sides.
#ifndef WELKIN_INTEROP_ATMOSPHERE_H
#define WELKIN_INTEROP_ATMOSPHERE_H

#if defined(__cplusplus) && !defined(WELKIN_SHADER_TWIN)
#include <cstddef>
#include <glm/vec3.hpp>

namespace welkin::interop {
using vec3 = glm::vec3;
#endif

struct Atmosphere {
  vec3 rayleigh_scattering;  // at the ground, 1/km
  float rayleigh_scale_height_km;
  vec3 mie_scattering;  // at the ground, 1/km
  float mie_scale_height_km;
  vec3 mie_extinction;    // scattering + absorption at the ground, 1/km
  float mie_g;            // asymmetry, |g| < 1
  vec3 ozone_absorption;  // at the peak, 1/km
  float ozone_peak_km;    // altitude
  float ground_radius_km;
  float top_km;  // altitude of the top: its radius would be known to 0.5 m only
  float ozone_half_width_km;
  float sun_angular_radius;  // rad
  vec3 ground_albedo;
  float second_g;         // asymmetry of the second lobe (double HG)
  vec3 solar_irradiance;  // at the top of the atmosphere
  float mie_alpha;        // Draine's alpha, or the second lobe's weight
};

#if defined(__cplusplus) && !defined(WELKIN_SHADER_TWIN)
static_assert(sizeof(Atmosphere) == 112);
static_assert(offsetof(Atmosphere, rayleigh_scattering) == 0 && offsetof(Atmosphere, rayleigh_scale_height_km) == 12);
static_assert(offsetof(Atmosphere, mie_scattering) == 16 && offsetof(Atmosphere, mie_scale_height_km) == 28);
static_assert(offsetof(Atmosphere, mie_extinction) == 32 && offsetof(Atmosphere, mie_g) == 44);
static_assert(offsetof(Atmosphere, ozone_absorption) == 48 && offsetof(Atmosphere, ozone_peak_km) == 60);
static_assert(offsetof(Atmosphere, ground_radius_km) == 64 && offsetof(Atmosphere, top_km) == 68);
static_assert(offsetof(Atmosphere, ozone_half_width_km) == 72 && offsetof(Atmosphere, sun_angular_radius) == 76);
static_assert(offsetof(Atmosphere, ground_albedo) == 80 && offsetof(Atmosphere, second_g) == 92);
static_assert(offsetof(Atmosphere, solar_irradiance) == 96 && offsetof(Atmosphere, mie_alpha) == 108);
}  // namespace welkin::interop
#endif

#endif
