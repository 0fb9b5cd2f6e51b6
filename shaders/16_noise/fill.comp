// Computes every texel of a texture, as it comes: not yet normalised.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "16_noise/textures.glsl"

layout(constant_id = 0) const int KIND = 0;
layout(binding = 0, rgba32f) uniform writeonly image3D raw;
layout(push_constant) uniform Push {
  int octaves;
  float gain;
  float full;
  int seed;
} push;

// [fill]
void main() {
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  const ivec3 size = imageSize(raw);
  if (any(greaterThanEqual(at, size))) return;
  const vec3 place = (vec3(at) + 0.5) * (1.0 / float(size.x));  // sides are powers of two: exact
  imageStore(raw, at, texel(KIND, place, Octaves(push.octaves, push.gain, push.full), uint(push.seed)));
}
// [/fill]
