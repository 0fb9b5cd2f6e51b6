// How often a channel of a volume has which of 256 numbers: every kRowsApart-th row by one workgroup, counted in shared memory first.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "16_noise/histogram.glsl"

layout(binding = 0) uniform sampler3D noise;

void main() {
  begin_counting();
  const ivec3 size = textureSize(noise, 0);
  for (int row = int(gl_WorkGroupID.x); row < size.y * size.z; row += kRowsApart)
    for (int x = int(gl_LocalInvocationIndex); x < size.x; x += 64) count(texelFetch(noise, ivec3(x, row % size.y, row / size.y), 0));
  end_counting();
}
