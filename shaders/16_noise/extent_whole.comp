// Second pass of the reduction: from the parts to the whole texture, and to the scale of each channel.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "16_noise/extent.glsl"

layout(constant_id = 0) const bool IS_SIGNED = false;
layout(binding = 0, std430) readonly buffer Parts { vec4 ends[2 * kParts]; } parts;
layout(binding = 1, std430) writeonly buffer Whole { Extent extent; } whole;

shared vec4 least[64];
shared vec4 greatest[64];

void main() {
  const int i = int(gl_LocalInvocationIndex);
  least[i] = parts.ends[2 * i];
  greatest[i] = parts.ends[2 * i + 1];
  for (int part = i + 64; part < kParts; part += 64) {
    least[i] = min(least[i], parts.ends[2 * part]);
    greatest[i] = max(greatest[i], parts.ends[2 * part + 1]);
  }
  for (int half_way = 32; half_way > 0; half_way /= 2) {
    barrier();
    if (i < half_way) {
      least[i] = min(least[i], least[i + half_way]);
      greatest[i] = max(greatest[i], greatest[i + half_way]);
    }
  }
  if (i == 0) whole.extent = extent_of(least[0], greatest[0], IS_SIGNED);
}
