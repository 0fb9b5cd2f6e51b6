// The display pass: exposure, tone curve, the screen's curve, 8 bits. Included by display_metered.comp and
// display_fixed.comp, which say where the exposure comes from.
#include "06_display/color.glsl"
#include "06_display/curves.glsl"
#include "06_display/noise.glsl"

layout(constant_id = 0) const int CURVE = 3;        // kCurves: all of them, side by side
layout(constant_id = 1) const int ON_LUMINANCE = 0;  // 1: the curve bends Y of xyY, and the colour keeps its x and y
layout(constant_id = 2) const int DITHER = 1;

layout(binding = 0, rgba32f) uniform readonly image2D picture;
layout(binding = 1, rgba8) uniform writeonly image2D displayed;
layout(push_constant) uniform Push {
  ivec2 size;
  float exposure;  // log2: of the factor, or of what is added to the meter's
} push;

// [toned]
vec3 toned(int curve, vec3 light) {
  if (ON_LUMINANCE == 0) return tone_rgb(curve, light);
  vec3 xyY = xyY_from_rgb(max(light, vec3(0.0)));
  xyY.z = tone_channel(curve, xyY.z);
  return fit_gamut(rgb_from_xyY(xyY), xyY.z);
}
// [/toned]

// [display]
void show(float log2_exposure) {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, push.size))) return;
  int curve = CURVE;
  ivec2 source = pixel;
  bool separator = false;
  if (CURVE == kCurves) {  // equal strips, each showing the middle of the picture through its own curve
    curve = min(pixel.x * kCurves / push.size.x, kCurves - 1);
    const int begin = (curve * push.size.x + kCurves - 1) / kCurves;
    source.x = clamp(pixel.x - begin + (push.size.x - push.size.x / kCurves) / 2, 0, push.size.x - 1);
    separator = pixel.x == begin && curve > 0;
  }
  const vec3 light = imageLoad(picture, source).rgb;
  vec3 level;
  if (any(isnan(light)) || any(isinf(light))) {
    level = vec3(255.0, 0.0, 255.0);  // magenta, so that it is seen
  } else if (separator) {
    level = vec3(0.0);
  } else {
    const vec3 screen = toned(curve, light * exp2(log2_exposure));
    for (int c = 0; c < 3; ++c) {
      const float encoded = srgb_encode(screen[c]);
      const float noise = DITHER == 1 ? dither_noise(uint(pixel.x), uint(pixel.y), uint(c)) : 0.0;
      level[c] = dithered_level(encoded, noise);
    }
  }
  imageStore(displayed, pixel, vec4(level / 255.0, 1.0));
}
// [/display]
