// The histogram in a strip of its own: 256 bars, lighter towards 1, and a line
// at every quarter. A bar as high as the strip is kFull times as frequent as if all numbers were equally so.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "16_noise/view.glsl"

layout(binding = 0, std430) readonly buffer Histogram { uint bins[256]; } histogram;

const float kFull = 5.0;

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (outside(at)) return;
  const float across = (float(at.x) + 0.5) / float(push.rectangle.z);
  const float share = float(histogram.bins[int(across * 256.0)]) * 256.0 / float(push.histogram);
  const float height = 1.0 - (float(at.y) + 0.5) / float(push.rectangle.w);
  const float quarter = abs(fract(across * 4.0 + 0.5) - 0.5) * float(push.rectangle.z) / 4.0;  // pixels from the nearest line
  vec3 color = vec3(quarter < 0.5 ? 0.3 : 0.08);
  if (height * kFull < share) color = vec3(0.3 + 0.7 * across);
  show(at, color);
}
