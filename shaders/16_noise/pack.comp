// The last step: each channel brought to 0 ... 1 (or -1 ... 1) and rounded to the texture's format. The words are copied into
// the texture as they are, and are what the cache keeps.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "16_noise/extent.glsl"
#include "16_noise/quantize.glsl"

layout(constant_id = 0) const int BITS = 8;  // of a channel
layout(constant_id = 1) const bool IS_SIGNED = false;
layout(constant_id = 2) const bool IS_HALF = false;  // 16 bits, floating
layout(binding = 0, rgba32f) uniform readonly image3D raw;
layout(binding = 1, std430) readonly buffer Whole { Extent extent; } whole;
layout(binding = 2, std430) writeonly buffer Words { uint words[]; } texture_words;

// [pack]
void main() {
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  const ivec3 size = imageSize(raw);
  if (any(greaterThanEqual(at, size))) return;
  const vec4 value = imageLoad(raw, at);
  uint channels[4];
  for (int i = 0; i < 4; i++) {
    precise float normalized = (value[i] - whole.extent.zero[i]) * whole.extent.scale[i];
    channels[i] = IS_HALF ? half_float(clamp(normalized, IS_SIGNED ? -1.0 : 0.0, 1.0)) : quantized(normalized, BITS, IS_SIGNED);
  }
  const int texel = at.x + size.x * (at.y + size.y * at.z);
  if (BITS == 8) {
    texture_words.words[texel] = channels[0] | channels[1] << 8 | channels[2] << 16 | channels[3] << 24;
  } else {
    texture_words.words[2 * texel] = channels[0] | channels[1] << 16;
    texture_words.words[2 * texel + 1] = channels[2] | channels[3] << 16;
  }
}
// [/pack]
