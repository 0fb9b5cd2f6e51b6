// From the histogram to the exposure: the mean of log2 luminance between two ranks, and one step of adaptation. One
// workgroup; an invocation has four bins.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "06_display/meter.glsl"

layout(binding = 0, std430) readonly buffer Histogram { uvec4 bins[64]; } histogram;
layout(binding = 1, std430) buffer State {
  float exposure;   // log2 of the factor
  float target;     // log2 of the factor it moves towards
  float mean_log2;  // mean log2 luminance of what was measured
  uint measured;    // samples with a luminance above 0
} state;
layout(push_constant) uniform Push {
  float low, high;           // ranks between which samples count, as shares of all measured, darkest first
  float to_bright, to_dark;  // shares of the way covered in this frame
  float adaptation;
  float fallback;            // exposure of a first picture that has nothing to measure
  int snap;                  // 1: no exposure before this one; go the whole way
} push;

shared uint counts[2][64];
shared vec2 sums[64];

// [exposure]
void main() {
  const uint lane = gl_LocalInvocationID.x;
  uvec4 here = histogram.bins[lane];
  if (lane == 0u) here.x = 0u;  // black has no logarithm
  const uint own = here.x + here.y + here.z + here.w;

  // Running totals over the lanes: after step k each holds the sum of 2^k lanes up to its own.
  counts[0][lane] = own;
  barrier();
  uint from = 0u;
  for (uint step = 1u; step < 64u; step *= 2u) {
    counts[1u - from][lane] = counts[from][lane] + (lane >= step ? counts[from][lane - step] : 0u);
    from = 1u - from;
    barrier();
  }
  const uint measured = counts[from][63];
  const float low = push.low * float(measured);
  const float high = push.high * float(measured);
  float before = float(counts[from][lane] - own);
  vec2 sum = vec2(0.0);  // counted samples, and their log2 luminance above the darkest
  for (uint i = 0u; i < 4u; ++i) {
    const float share = counted_share(before, float(here[i]), low, high);
    sum += share * vec2(1.0, meter_value(4u * lane + i) - kMeterDarkest);
    before += float(here[i]);
  }
  sums[lane] = sum;
  barrier();
  for (uint half_count = 32u; half_count > 0u; half_count /= 2u) {
    if (lane < half_count) sums[lane] += sums[lane + half_count];
    barrier();
  }
  if (lane == 0u) {
    const bool anything = sums[0].x > 0.0;
    const float mean = anything ? kMeterDarkest + sums[0].y / sums[0].x : 0.0;
    const float held = push.snap == 1 ? push.fallback : state.exposure;
    const float target = anything ? meter_target(mean, push.adaptation) : held;
    state.exposure = push.snap == 1 ? target : adapt(held, target, push.to_bright, push.to_dark);
    state.target = target;
    state.mean_log2 = mean;
    state.measured = measured;
  }
}
// [/exposure]
