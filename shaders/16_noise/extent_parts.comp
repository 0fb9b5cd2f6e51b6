// First pass of the reduction: the least and the greatest number of each channel in one of kParts parts of the texture.
// A part is every kParts-th row. Minima and maxima do not depend on the order in which they are taken: no rounding.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "16_noise/extent.glsl"

layout(binding = 0, rgba32f) uniform readonly image3D raw;
layout(binding = 1, std430) writeonly buffer Parts { vec4 ends[2 * kParts]; } parts;

shared vec4 least[64];
shared vec4 greatest[64];

// [parts]
void main() {
  const ivec3 size = imageSize(raw);
  const int i = int(gl_LocalInvocationIndex);
  vec4 low = vec4(3.0e38);
  vec4 high = vec4(-3.0e38);
  for (int row = int(gl_WorkGroupID.x); row < size.y * size.z; row += kParts)
    for (int x = i; x < size.x; x += 64) {
      const vec4 value = imageLoad(raw, ivec3(x, row % size.y, row / size.y));
      low = min(low, value);
      high = max(high, value);
    }
  least[i] = low;
  greatest[i] = high;
  for (int half_way = 32; half_way > 0; half_way /= 2) {
    barrier();
    if (i < half_way) {
      least[i] = min(least[i], least[i + half_way]);
      greatest[i] = max(greatest[i], greatest[i + half_way]);
    }
  }
  if (i == 0) {
    parts.ends[2 * gl_WorkGroupID.x] = least[0];
    parts.ends[2 * gl_WorkGroupID.x + 1] = greatest[0];
  }
}
// [/parts]
