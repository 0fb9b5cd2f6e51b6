// The constant-density sky along many rays: one invocation per vertex of the sky sphere, or per ray of --probe.
//
// A vertex is one vec4 (unit direction); camera and sun are those of the frame. A probe's ray is two vec4, (view,
// altitude in km) and (sun, 0), and so is its result: radiance and transmittance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/variant.glsl"
layout(constant_id = 4) const int PHASE_DETAIL = 3;
layout(constant_id = 5) const bool PROBE = false;
#include "04_air/constant_sky.glsl"
#include "interop/camera.h"
layout(local_size_x = 64) in;
layout(binding = 0) uniform Air { Atmosphere atmosphere; };
layout(binding = 1) readonly buffer Rays { vec4 rays[]; };
layout(binding = 2) writeonly buffer Results { vec4 results[]; };
layout(push_constant) uniform Push { CameraRays camera; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (PROBE) {
    if (2u * i >= rays.length()) return;
    const ConstantSky sky = constant_sky(atmosphere, rays[2u * i].w, rays[2u * i].xyz, rays[2u * i + 1u].xyz);
    results[2u * i] = vec4(sky.radiance, 1.0);
    results[2u * i + 1u] = vec4(sky.transmittance, 1.0);
  } else {
    if (i >= rays.length()) return;
    results[i] = vec4(constant_sky(atmosphere, camera.altitude_km, rays[i].xyz, camera.sun).radiance, 1.0);
  }
}
