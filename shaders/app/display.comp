// From the linear picture to 8 bits, until chapter 06 teaches how. Mode 0: values as they are, clamped. Mode 1: 1 -
// exp(-exposure L), then the sRGB curve (IEC 61966-2-1). A value that is not finite becomes magenta: seen, not hidden.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D picture;
layout(binding = 1, rgba8) uniform writeonly image2D displayed;
layout(push_constant) uniform Push {
  ivec2 size;
  float exposure;
  int mode;
} push;

vec3 srgb_from_linear(vec3 linear) {
  return mix(12.92 * linear, 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055,
             greaterThan(linear, vec3(0.0031308)));
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, push.size))) return;
  vec3 value = imageLoad(picture, pixel).rgb;
  if (any(isnan(value)) || any(isinf(value))) {
    value = vec3(1.0, 0.0, 1.0);
  } else if (push.mode == 1) {
    value = srgb_from_linear(1.0 - exp(-push.exposure * max(value, vec3(0.0))));
  }
  imageStore(displayed, pixel, vec4(clamp(value, 0.0, 1.0), 1.0));
}
