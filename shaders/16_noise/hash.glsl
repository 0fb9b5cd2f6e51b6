// Random numbers from whole ones: pcg4d (Jarzynski and Olano 2020). Integer arithmetic wraps the same way everywhere, so the
// bits are those of every device and of the processor; fract(sin(x)) is another function on each of them.
#ifndef WELKIN_NOISE_HASH_GLSL
#define WELKIN_NOISE_HASH_GLSL

// [hash]
// Four numbers of 32 bits from a cell and a seed: every bit of each depends on every bit of all.
uvec4 hashed(ivec3 cell, uint seed) {
  uvec4 v = uvec4(uvec3(cell), seed) * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// 0 ... 1 - 2^-24, exactly: a float holds 24 bits.
float unit_float(uint bits) { return float(bits >> 8u) * (1.0 / 16777216.0); }
// [/hash]

// [wrapped]
// The cell that stands for this one where space repeats after `period` cells, a power of two; also of negative cells, whose
// remainder by % Vulkan leaves undefined.
ivec3 wrapped(ivec3 cell, int period) { return cell & (period - 1); }
ivec2 wrapped(ivec2 cell, int period) { return cell & (period - 1); }
// [/wrapped]

#endif
