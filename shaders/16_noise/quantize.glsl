// Numbers as a texture's format stores them, rounded to the nearest here and not by the device, which may do it as it likes.
#ifndef WELKIN_NOISE_QUANTIZE_GLSL
#define WELKIN_NOISE_QUANTIZE_GLSL

// [quantize]
// Whole steps from 0 ... 1 (is_signed: -1 ... 1) with 2^bits - 1 (2^(bits - 1) - 1) steps to 1, in `bits` bits.
uint quantized(float value, int bits, bool is_signed) {
  float most = float((1 << (is_signed ? bits - 1 : bits)) - 1);
  precise float steps = clamp(abs(value), 0.0, 1.0) * most + 0.5;
  int whole = int(floor(steps));
  if (!is_signed) return value > 0.0 ? uint(whole) : 0u;
  return uint(value < 0.0 ? -whole : whole) & uint((1 << bits) - 1);
}

// The nearest half float, of two as near the even one. |value| below 2^-14 in steps of 2^-24, as halves have them there.
uint half_float(float value) {
  uint bits = floatBitsToUint(value);
  uint sign = (bits >> 16u) & 0x8000u;
  float size = min(abs(value), 65504.0);
  if (size < 6.103515625e-5) {
    float steps = size * 16777216.0;  // exact
    float whole = floor(steps);
    float rest = steps - whole;
    uint down = uint(whole);
    return sign | (rest > 0.5 || (rest == 0.5 && (down & 1u) == 1u) ? down + 1u : down);
  }
  uint rounded = floatBitsToUint(size) - 0x38000000u;  // exponent 127 becomes 15
  rounded += 0xFFFu + ((rounded >> 13u) & 1u);
  return sign | (rounded >> 13u);
}
// [/quantize]

#endif
