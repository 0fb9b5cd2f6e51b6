// Sums the light of all directions for one texel, in one workgroup. For the entry points that write the table.
#ifndef WELKIN_REDUCE_GLSL
#define WELKIN_REDUCE_GLSL

#include "09_multiple_scattering_lut/gather_block.glsl"

layout(local_size_x = 64) in;  // one workgroup per texel
const int THREADS = 64;

// Threads per direction, each with a part of its nodes, where there are fewer directions than threads.
const int PARTS = THREADS > DIRECTIONS ? THREADS / DIRECTIONS : 1;

const int kComponents = 3 * kLayers;
shared float partial[THREADS][kComponents];
shared float total[kComponents];

void add(int layer, vec3 value) {
  const uint thread = gl_LocalInvocationID.x;
  partial[thread][3 * layer] += value.r;
  partial[thread][3 * layer + 1] += value.g;
  partial[thread][3 * layer + 2] += value.b;
}

// [reduce]
// Thread k sums component k over all threads. A tree reduction would take six rounds, each with a barrier and most
// threads idle; here the 21 components give 21 threads a sum each.
void sum_over_threads(int layers) {
  barrier();
  for (int k = int(gl_LocalInvocationID.x); k < 3 * layers; k += THREADS) {
    float sum = 0.0;
    for (int thread = 0; thread < THREADS; ++thread) sum += partial[thread][k];
    total[k] = sum;
  }
  barrier();
}

vec3 sum_of(int layer) { return vec3(total[3 * layer], total[3 * layer + 1], total[3 * layer + 2]); }
// [/reduce]

void clear_sums() {
  for (int k = 0; k < kComponents; ++k) partial[gl_LocalInvocationID.x][k] = 0.0;
}

// Adds one direction's light to this thread's sums.
void add_direction(WeightedDirection direction, vec3 light) {
  const vec3 d = direction.view;
  const vec3 weighted = light * direction.weight;
  add(0, weighted);
  add(1, weighted * d.z);
  add(2, weighted * d.x);
  add(3, weighted * (d.z * d.z));
  add(4, weighted * (d.x * d.z));
  add(5, weighted * (d.x * d.x - d.y * d.y));
  add(6, weighted * max(4.0 * d.z, 0.0));  // int L d_z over the upper half / pi
}

#endif
