// Chapter 01: every pixel of an image, each by one invocation.
//
// A dawn gradient in whole numbers 0..255, so that every driver must give the same bits: integer arithmetic is exact,
// and so is one product of two floats, rounded as IEEE 754 says. (A float division may be off by 2.5 ulp in Vulkan.)
#version 460
// [workgroup]
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  ivec2 size;
} push;
// [/workgroup]

// [gradient]
// Rounded mean of two whole numbers with weights (length - 1 - position) and position; length 1 gives the first.
ivec3 blend(ivec3 first, ivec3 last, int position, int length) {
  const int span = max(length - 1, 1);
  return (first * (span - position) + last * position + span / 2) / span;
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  // Workgroups are 8x8 and the image need not be a multiple of that: the invocations beyond its edge do nothing.
  if (any(greaterThanEqual(pixel, push.size))) return;
  const ivec3 night = blend(ivec3(16, 24, 72), ivec3(96, 64, 88), pixel.y, push.size.y);
  const ivec3 dawn = blend(ivec3(64, 112, 200), ivec3(255, 176, 96), pixel.y, push.size.y);
  const ivec3 level = blend(night, dawn, pixel.x, push.size.x);
  imageStore(target, pixel, vec4(vec3(level) * (1.0 / 255.0), 1.0));
}
// [/gradient]
