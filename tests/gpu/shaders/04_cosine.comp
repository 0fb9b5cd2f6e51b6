// Harness: 1 - cosine of two unit vectors. In: a.xyz, b.xyz. Out: |a-b|^2/2, 1 - dot(a, b).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "04_air/phase.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer In { float values[]; } inputs;
layout(binding = 1) writeonly buffer Out { float values[]; } outputs;
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uint p = 6u * i;
  const vec3 a = vec3(inputs.values[p], inputs.values[p + 1u], inputs.values[p + 2u]);
  const vec3 b = vec3(inputs.values[p + 3u], inputs.values[p + 4u], inputs.values[p + 5u]);
  outputs.values[2u * i] = one_minus_cosine(a, b);
  outputs.values[2u * i + 1u] = 1.0 - dot(a, b);
}
