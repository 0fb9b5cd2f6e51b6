// Functions of chapter 16 over arrays. Reads eight floats an item: place (3), cells, seed, octaves, gain, 1 over the sum of
// the strengths; writes four. WHAT: which function.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "16_noise/extent.glsl"
#include "16_noise/quantize.glsl"
#include "16_noise/textures.glsl"

layout(constant_id = 0) const int WHAT = 0;
layout(binding = 0, std430) readonly buffer Inputs { float inputs[]; };
layout(binding = 1, std430) writeonly buffer Outputs { vec4 outputs[]; };
layout(push_constant) uniform Push { uint count; };

vec4 result_of(vec3 p, int cells, uint seed, Octaves octaves) {
  switch (WHAT) {
    case 0: return perlin(p, cells, seed);
    case 1: return vec4(perlin(p.xy, cells, seed), 0.0);
    case 2: return vec4(inverted_worley(p, cells, seed));
    case 3: return vec4(inverted_worley(p.xy, cells, seed));
    case 4: return vec4(alligator(p, cells, seed));
    case 5: return curl(p.xy, cells, octaves, seed);
    case 6: return vec4(curl(p, cells, octaves, seed), 0.0);
    case 7: return texel(cells, p, octaves, seed);
    case 8: return vec4(reciprocal(p.x), float(half_float(p.x)), float(quantized(p.x, 8, false)), float(quantized(p.x, 16, true)));
    default: {
      uvec4 hash = hashed(ivec3(p), seed);
      return vec4(unit_float(hash.x), unit_float(hash.y), unit_float(hash.z), unit_float(hash.w));
    }
  }
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  float a[8];
  for (int i = 0; i < 8; ++i) a[i] = inputs[8u * item + uint(i)];
  outputs[item] = result_of(vec3(a[0], a[1], a[2]), int(a[3]), uint(a[4]), Octaves(int(a[5]), a[6], a[7]));
}
