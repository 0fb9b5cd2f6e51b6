// A pixel of the sky sphere: the interpolated colour of the corners, or the sky along the interpolated direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/variant.glsl"
layout(constant_id = 4) const int PHASE_DETAIL = 3;
layout(constant_id = 5) const bool PER_VERTEX = true;
#include "04_air/constant_sky.glsl"
#include "interop/camera.h"
layout(binding = 0) uniform Air { Atmosphere atmosphere; };
layout(push_constant) uniform Push { CameraRays camera; };
layout(location = 0) in vec3 direction;
layout(location = 1) in vec3 colour;
layout(location = 0) out vec4 radiance;

void main() {
  if (PER_VERTEX) radiance = vec4(colour, 1.0);
  else radiance = vec4(constant_sky(atmosphere, camera.altitude_km, normalize(direction), camera.sun).radiance, 1.0);
}
