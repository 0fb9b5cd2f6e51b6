// What the air, the ground and the sun are made of, as the shaders see them. Included by C++ and by GLSL.
//
// Units: km, 1/km, radians. std140: every member is a vec4, so the layout is the same on both sides.
#ifndef WELKIN_INTEROP_ATMOSPHERE_H
#define WELKIN_INTEROP_ATMOSPHERE_H

#if defined(__cplusplus) && !defined(WELKIN_SHADER_TWIN)
#include <glm/vec4.hpp>

#include <cstddef>

namespace welkin::interop {
using vec4 = glm::vec4;
#endif

struct Atmosphere {
  vec4 rayleigh;        // xyz: scattering at the ground, 1/km; w: scale height, km
  vec4 mie_scattering;  // xyz: scattering at the ground, 1/km; w: scale height, km
  vec4 mie_extinction;  // xyz: scattering + absorption at the ground, 1/km; w: asymmetry g, |g| < 1
  vec4 ozone;           // xyz: absorption at the peak, 1/km; w: altitude of the peak, km
  vec4 shape;           // x: ground radius, km; y: altitude of the top, km (its radius would be known to 0.5 m only); z: ozone half width, km; w: sun's angular radius, rad
  vec4 ground;          // xyz: albedo; w: asymmetry of the second lobe (double HG)
  vec4 sun;             // xyz: irradiance at the top of the atmosphere; w: Draine's alpha, or the second lobe's weight
};

#if defined(__cplusplus) && !defined(WELKIN_SHADER_TWIN)
static_assert(sizeof(Atmosphere) == 112);
static_assert(offsetof(Atmosphere, rayleigh) == 0);
static_assert(offsetof(Atmosphere, mie_scattering) == 16);
static_assert(offsetof(Atmosphere, mie_extinction) == 32);
static_assert(offsetof(Atmosphere, ozone) == 48);
static_assert(offsetof(Atmosphere, shape) == 64);
static_assert(offsetof(Atmosphere, ground) == 80);
static_assert(offsetof(Atmosphere, sun) == 96);
}  // namespace welkin::interop
#endif

#endif
