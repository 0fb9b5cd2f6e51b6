// A workgroup's sum: what 64 directions bring to one texel. For the entry points that write the table.
#ifndef WELKIN_REDUCE_GLSL
#define WELKIN_REDUCE_GLSL

layout(local_size_x = 64) in;  // along x, one workgroup a texel: the directions are the threads
layout(constant_id = 7) const int DIRECTIONS = 64;
layout(constant_id = 8) const int DIRECTION_SET = 1;
layout(constant_id = 9) const int STEPS = 12;

shared vec3 partial[kLayers][64];

// [reduce]
// Half the threads add the other half's values, and so on: six steps. Every thread meets every barrier.
void sum_over_threads(int layers) {
  const uint thread = gl_LocalInvocationID.x;
  for (uint half_of = 32; half_of > 0; half_of >>= 1) {
    barrier();
    if (thread < half_of) {
      for (int layer = 0; layer < layers; ++layer) partial[layer][thread] += partial[layer][thread + half_of];
    }
  }
  barrier();
}
// [/reduce]

// The point a texel stands for. x: sun's zenith cosine, y: altitude.
vec2 texel_point(ivec2 texel) { return table_point(MS_MAP, atmosphere.shape.y, table_unit_of_texel(vec2(texel), float(MS_SIZE))); }

// Adds one direction's light to this thread's sums.
void add_direction(WeightedDirection direction, vec3 light) {
  const uint thread = gl_LocalInvocationID.x;
  const vec3 d = direction.look;
  const vec3 weighted = light * direction.weight;
  partial[0][thread] += weighted;
  partial[1][thread] += weighted * d.z;
  partial[2][thread] += weighted * d.x;
  partial[3][thread] += weighted * (d.z * d.z);
  partial[4][thread] += weighted * (d.x * d.z);
  partial[5][thread] += weighted * (d.x * d.x - d.y * d.y);
  partial[6][thread] += weighted * max(4.0 * d.z, 0.0);  // int L d_z over the upper half / pi
}

#endif
