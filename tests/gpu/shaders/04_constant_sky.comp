// Harness: the constant-density sky and the medium. In: the 28 floats of Atmosphere, altitude_km, view.xyz, sun.xyz.
// Out: radiance.xyz, transmittance.xyz, hits_ground, densities.xyz and extinction.xyz at the altitude.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/variant.glsl"
layout(constant_id = 4) const int PHASE_DETAIL = 3;
#include "04_air/constant_sky.glsl"
#include "../tests/gpu/shaders/atmosphere_of.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer In { float values[]; } inputs;
layout(binding = 1) writeonly buffer Out { float values[]; } outputs;
layout(push_constant) uniform Push { uint count; };

vec4 four(uint at) { return vec4(inputs.values[at], inputs.values[at + 1u], inputs.values[at + 2u], inputs.values[at + 3u]); }

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uint p = 35u * i, q = 13u * i;
  const Atmosphere atmosphere = atmosphere_of(four(p), four(p + 4u), four(p + 8u), four(p + 12u), four(p + 16u), four(p + 20u), four(p + 24u));
  const vec3 view = four(p + 29u).xyz;
  const vec3 sun = vec3(inputs.values[p + 32u], inputs.values[p + 33u], inputs.values[p + 34u]);
  const float altitude = inputs.values[p + 28u];
  const ConstantSky sky = constant_sky(atmosphere, altitude, view, sun);
  const vec3 density = densities(atmosphere, altitude);
  const vec3 sigma = extinction(atmosphere, density);
  const float result[13] = float[13](sky.radiance.x, sky.radiance.y, sky.radiance.z, sky.transmittance.x, sky.transmittance.y, sky.transmittance.z,
                                     sky.hits_ground, density.x, density.y, density.z, sigma.x, sigma.y, sigma.z);
  for (uint k = 0u; k < 13u; ++k) outputs.values[q + k] = result[k];
}
