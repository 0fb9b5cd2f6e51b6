// Counts the picture's log2 luminance into 256 bins. A workgroup counts its tile in shared memory and then adds each
// bin to the picture's once, instead of once per sample.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "06_display/meter.glsl"

layout(binding = 0, rgba32f) uniform readonly image2D picture;
layout(binding = 1, std430) buffer Histogram { uint bins[]; } histogram;
layout(push_constant) uniform Push {
  ivec2 size;
  ivec2 samples;  // ceil(size / stride)
  int stride;     // of every stride x stride pixels the one in the middle is counted
} push;

shared uint local_bins[kMeterBins];

// [histogram]
void main() {
  for (uint bin = gl_LocalInvocationIndex; bin < kMeterBins; bin += 64u) local_bins[bin] = 0u;
  barrier();
  // 32 x 32 samples per workgroup, 16 per invocation. Samples beyond the edge are skipped, but no invocation returns:
  // all have to reach the barrier.
  for (int i = 0; i < 16; ++i) {
    const ivec2 place = ivec2(gl_WorkGroupID.xy) * 32 + ivec2(i & 3, i >> 2) * 8 + ivec2(gl_LocalInvocationID.xy);
    if (place.x < push.samples.x && place.y < push.samples.y) {
      const ivec2 pixel = min(place * push.stride + push.stride / 2, push.size - 1);
      const float light = luminance(imageLoad(picture, pixel).rgb);
      atomicAdd(local_bins[meter_bin(light, pixel_noise(place.x, place.y, 0u))], 1u);
    }
  }
  barrier();
  for (uint bin = gl_LocalInvocationIndex; bin < kMeterBins; bin += 64u)
    if (local_bins[bin] > 0u) atomicAdd(histogram.bins[bin], local_bins[bin]);
}
// [/histogram]
