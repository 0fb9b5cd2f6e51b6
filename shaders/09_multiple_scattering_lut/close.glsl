// The rest of the series, and the table as it is kept. Included by close_half.comp and close_float.comp, which declare the
// image `kept`.
//
// Orders far up the series look alike: each is the one before times the same factor r, the share of light that air and
// ground do not lose in one more scattering. The two last steps of the table measure r, and what is missing is a
// geometric series: M + (M - M') r / (1 - r).
layout(local_size_x = 8, local_size_y = 8) in;
#include "09_multiple_scattering_lut/variant.glsl"

layout(binding = 1, rgba32f) uniform readonly image2D orders;      // n orders
layout(binding = 2, rgba32f) uniform readonly image2D one_less;    // n - 1
layout(binding = 3, rgba32f) uniform readonly image2D two_less;    // n - 2
layout(constant_id = 7) const bool EXTRAPOLATE = true;

// [close]
void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(MS_SIZE)))) return;
  const vec3 stored = imageLoad(orders, texel).rgb;
  vec3 mean = decode_mean(stored);
  vec3 more = vec3(0.0);  // of (M - M') to be added
  vec3 mean_before = mean;
  if (EXTRAPOLATE) {
    mean_before = decode_mean(imageLoad(one_less, texel).rgb);
    const vec3 step = max(mean - mean_before, vec3(0.0));
    const vec3 step_before = max(mean_before - decode_mean(imageLoad(two_less, texel).rgb), vec3(1.0e-37));
    const vec3 r = min(step / step_before, vec3(0.98));
    more = r / (1.0 - r);
  }
  const vec3 closed = mean + max(mean - mean_before, vec3(0.0)) * more;
  imageStore(kept, texel, vec4(encode_mean(closed), 0.0));
  for (int layer = 1; layer < table_layers(MS_METHOD); ++layer) {
    const ivec2 place = texel + ivec2(0, layer * MS_SIZE);
    vec3 moment = imageLoad(orders, place).rgb;
    if (EXTRAPOLATE) moment = (moment * mean + (moment * mean - imageLoad(one_less, place).rgb * mean_before) * more) / max(closed, vec3(kLeastMean));
    imageStore(kept, place, vec4(moment, 0.0));
  }
}
// [/close]
