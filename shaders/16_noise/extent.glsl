// The range of each channel, and how a number is brought to 0 ... 1 (or -1 ... 1) by it.
#ifndef WELKIN_NOISE_EXTENT_GLSL
#define WELKIN_NOISE_EXTENT_GLSL

const int kParts = 256;  // of a texture, each reduced by one workgroup in the first pass

struct Extent {
  vec4 zero;   // becomes 0
  vec4 scale;  // times what is above it
};

// [reciprocal]
// 1 / x with the same bits everywhere: Vulkan lets a division err by 2.5 units in the last place, whole numbers and products
// leave no choice. Newton's step y (2 - x y) doubles the right digits of a start from whole numbers. x: 2^-60 ... 2^60.
float reciprocal(float x) {
  uint bits = floatBitsToUint(x);
  int exponent = int(bits >> 23u);                             // x = m 2^(exponent - 127), m 1 ... 2
  uint digits = ((bits & 0x7FFFFFu) | 0x800000u) >> 8u;        // m 2^15
  uint start = 0x80000000u / digits;                           // 2^16 / m, to one part in 2^14
  precise float y = float(start) * uintBitsToFloat(uint(238 - exponent) << 23u);
  for (int i = 0; i < 2; i++) y = y * (2.0 - x * y);
  return y;
}
// [/reciprocal]

// [extent]
// From the least and the greatest number of each channel. Signed: 0 stays 0, and the first three, components of one
// vector, share a scale; a scale of its own for each would give a field without divergence some.
Extent extent_of(vec4 least, vec4 greatest, bool is_signed) {
  vec4 zero = is_signed ? vec4(0.0) : least;
  vec4 span = is_signed ? max(abs(least), abs(greatest)) : greatest - least;
  if (is_signed) span.xyz = vec3(max(span.x, max(span.y, span.z)));
  vec4 scale;
  for (int i = 0; i < 4; i++) scale[i] = span[i] > 0.0 ? reciprocal(span[i]) : 0.0;
  return Extent(zero, scale);
}
// [/extent]

#endif
