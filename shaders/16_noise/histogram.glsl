// Counting into a histogram, for both of its shaders.
#ifndef WELKIN_NOISE_HISTOGRAM_GLSL
#define WELKIN_NOISE_HISTOGRAM_GLSL

const int kRowsApart = 64;  // as many workgroups as that

layout(binding = 1, std430) buffer Histogram { uint bins[256]; } histogram;
layout(push_constant) uniform Push {
  int channel;  // 4: the first three, together
  int is_signed;
} push;

shared uint counts[256];

void begin_counting() {
  for (uint bin = gl_LocalInvocationIndex; bin < 256u; bin += 64u) counts[bin] = 0u;
  barrier();
}

void count_one(float value) {
  if (push.is_signed != 0) value = 0.5 + 0.5 * value;
  atomicAdd(counts[min(uint(max(value, 0.0) * 256.0), 255u)], 1u);
}

void count(vec4 value) {
  if (push.channel < 4) count_one(value[push.channel]);
  else for (int i = 0; i < 3; i++) count_one(value[i]);
}

void end_counting() {
  barrier();
  for (uint bin = gl_LocalInvocationIndex; bin < 256u; bin += 64u)
    if (counts[bin] > 0u) atomicAdd(histogram.bins[bin], counts[bin]);
}

#endif
