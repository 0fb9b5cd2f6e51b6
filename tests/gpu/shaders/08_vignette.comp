// The sample effect of CONTRIBUTING.md: the picture, darker towards its corners.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D before;
layout(binding = 1, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  float strength;
};

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(target);
  if (any(greaterThanEqual(pixel, size))) return;
  const vec2 from_middle = (2.0 * vec2(pixel) + 1.0) / vec2(size) - 1.0;
  const float shade = 1.0 - strength * 0.5 * dot(from_middle, from_middle);
  imageStore(target, pixel, imageLoad(before, pixel) * vec4(vec3(shade), 1.0));
}
