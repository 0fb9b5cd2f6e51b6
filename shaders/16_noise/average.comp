// One mip from the next finer one: the mean of eight texels (of four, where there is one slice), so that the mean of a mip
// is that of the texture. Averaged as floats, before anything is rounded to the texture's format.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image3D finer;
layout(binding = 1, rgba32f) uniform writeonly image3D coarser;

// [average]
void main() {
  const ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(coarser)))) return;
  const int slices = min(imageSize(finer).z, 2);
  precise vec4 sum = vec4(0.0);
  for (int k = 0; k < slices; k++)
    for (int j = 0; j < 2; j++)
      for (int i = 0; i < 2; i++) sum = sum + imageLoad(finer, ivec3(2 * at.xy + ivec2(i, j), slices * at.z + k));
  imageStore(coarser, at, sum * (slices == 2 ? 0.125 : 0.25));
}
// [/average]
