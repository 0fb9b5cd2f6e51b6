// Writes the next mip: the largest of four texels.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) uniform readonly image2D finer;
layout(binding = 1, r32f) uniform writeonly image2D coarser;

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(coarser)))) return;
  float largest = 0.0;
  for (int i = 0; i < 4; ++i) largest = max(largest, imageLoad(finer, 2 * texel + ivec2(i & 1, i >> 1)).r);
  imageStore(coarser, texel, vec4(largest));
}
