// single_scattering() over an array of rays, each with an atmosphere of its own. Reads 40 floats an item: the seven vec4
// of Atmosphere, view (w: altitude, km), sun, (view steps, light steps, unused, unused); writes radiance and transmittance.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool HAS_RAYLEIGH = true;
layout(constant_id = 1) const bool HAS_MIE = true;
layout(constant_id = 2) const bool HAS_OZONE = true;
layout(constant_id = 3) const int MIE_PHASE = 0;
layout(constant_id = 4) const int RULE = 5;
#include "05_single_scattering/single_scattering.glsl"
#include "../tests/gpu/shaders/atmosphere_of.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  vec4 inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint first = 10 * item;
  const Atmosphere atmosphere = atmosphere_of(inputs[first], inputs[first + 1], inputs[first + 2], inputs[first + 3],
                                           inputs[first + 4], inputs[first + 5], inputs[first + 6]);
  const vec4 view = inputs[first + 7];
  const vec4 steps = inputs[first + 9];
  const RayLight light =
      single_scattering(atmosphere, view.w, view.xyz, inputs[first + 8].xyz, int(steps.x), int(steps.y), RULE);
  for (int channel = 0; channel < 3; ++channel) {
    outputs[6 * item + channel] = light.radiance[channel];
    outputs[6 * item + 3 + channel] = light.transmittance[channel];
  }
}
