// Adds the orders that were not gathered and writes the final table. Included by close_half.comp and close_float.comp,
// which declare the image `final_table`.
//
// High orders are proportional to each other: each is the one before times the same factor r, the fraction of light
// that air and ground do not lose in one more scattering. The last two gathered orders give r. The missing orders are a
// geometric series: with M the sum of n orders and M' the sum of n - 1, the total is M + (M - M') r / (1 - r).
layout(local_size_x = 8, local_size_y = 8) in;
#include "09_multiple_scattering_lut/variant.glsl"

layout(binding = 1, rgba32f) uniform readonly image2D orders;          // sum of n orders
layout(binding = 2, rgba32f) uniform readonly image2D orders_minus_1;  // of n - 1
layout(binding = 3, rgba32f) uniform readonly image2D orders_minus_2;  // of n - 2
layout(constant_id = 7) const bool EXTRAPOLATE = true;

// [close]
void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(MS_SIZE)))) return;
  const vec3 stored = imageLoad(orders, texel).rgb;
  vec3 mean = decode_mean(stored);
  vec3 tail = vec3(0.0);  // r / (1 - r)
  vec3 mean_before = mean;
  if (EXTRAPOLATE) {
    mean_before = decode_mean(imageLoad(orders_minus_1, texel).rgb);
    const vec3 last_order = max(mean - mean_before, vec3(0.0));
    const vec3 order_before = max(mean_before - decode_mean(imageLoad(orders_minus_2, texel).rgb), vec3(1.0e-37));
    const vec3 r = min(last_order / order_before, vec3(0.98));
    tail = r / (1.0 - r);
  }
  const vec3 total = mean + max(mean - mean_before, vec3(0.0)) * tail;
  imageStore(final_table, texel, vec4(encode_mean(total), 0.0));
  for (int layer = 1; layer < table_layers(MS_METHOD); ++layer) {
    const ivec2 layer_texel = texel + ivec2(0, layer * MS_SIZE);
    vec3 moment = imageLoad(orders, layer_texel).rgb;
    if (EXTRAPOLATE)
      moment = (moment * mean + (moment * mean - imageLoad(orders_minus_1, layer_texel).rgb * mean_before) * tail) /
               max(total, vec3(kMinMean));
    imageStore(final_table, layer_texel, vec4(moment, 0.0));
  }
}
// [/close]
