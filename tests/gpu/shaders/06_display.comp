// Single functions of chapter 06 over arrays. Reads eight floats an item: which function, then its arguments; writes four.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "06_display/curves.glsl"
#include "06_display/meter.glsl"

layout(binding = 0, std430) readonly buffer Inputs { float inputs[]; };
layout(binding = 1, std430) writeonly buffer Outputs { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  float a[8];
  for (int i = 0; i < 8; ++i) a[i] = inputs[8u * item + uint(i)];
  vec4 result = vec4(0.0);
  const int part = int(a[0]);
  if (part == 0) {  // curve, x: the published curve, the same after its grey gain, and hable() as printed
    result.x = published_curve(int(a[1]), tone_input(a[2]));
    result.y = tone_channel(int(a[1]), a[2]);
    result.z = hable(tone_input(a[2]));
    result.w = hable_naive(tone_input(a[2]));
  } else if (part == 1) {  // curve, rgb
    result.xyz = tone_rgb(int(a[1]), vec3(a[2], a[3], a[4]));
  } else if (part == 2) {  // x, p, a, m, l, c, b
    result.x = uchimura(tone_input(a[1]), a[2], a[3], a[4], a[5], a[6], a[7]);
  } else if (part == 3) {  // rgb: to xyY and back
    const vec3 xyY = xyY_from_rgb(vec3(a[1], a[2], a[3]));
    result = vec4(xyY, 0.0);
  } else if (part == 4) {
    result.xyz = rgb_from_xyY(vec3(a[1], a[2], a[3]));
  } else if (part == 5) {  // encoded, noise: srgb, dithered level
    result.x = srgb_encode(a[1]);
    result.y = dithered_level(a[1], a[2]);
  } else if (part == 6) {  // luminance, noise: bin and its value
    const uint bin = meter_bin(a[1], a[2]);
    result.x = float(bin);
    result.y = meter_value(bin);
  } else if (part == 8) {  // rgb of luminance at most 1: what a screen can show of it
    const vec3 rgb = vec3(a[1], a[2], a[3]);
    result = vec4(fit_gamut(rgb, luminance(rgb)), 0.0);
  } else {  // x, y, seed: noise, dither
    result.x = pixel_noise(uint(a[1]), uint(a[2]), uint(a[3]));
    result.y = dither_noise(uint(a[1]), uint(a[2]), uint(a[3]));
  }
  for (int i = 0; i < 4; ++i) outputs[4u * item + uint(i)] = result[i];
}
