// Fills a map with each texel's index.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 3) const float SCALE = 1.0;
layout(binding = 0, r32f) uniform writeonly image2D map;

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(map);
  if (all(lessThan(texel, size))) imageStore(map, texel, vec4(SCALE * float(texel.y * size.x + texel.x)));
}
