// A map in a rectangle of the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "16_noise/view.glsl"

layout(binding = 0) uniform sampler2D noise;

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (outside(at)) return;
  show(at, shown(textureLod(noise, place_of(at), push.mip)));
}
