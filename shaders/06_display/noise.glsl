// Reproducible noise from integers: the same bits on every driver.
#ifndef WELKIN_NOISE_GLSL
#define WELKIN_NOISE_GLSL

// [hash]
// A bijection of 32 bits whose output bits each depend on all input bits (the "lowbias32" of Wellons 2018).
uint hash_bits(uint x) {
  x ^= x >> 16u;
  x *= 0x7feb352du;
  x ^= x >> 15u;
  x *= 0x846ca68bu;
  x ^= x >> 16u;
  return x;
}

// Uniform in [0, 1), 24 bits: every value is exact in float32.
float pixel_noise(uint x, uint y, uint seed) {
  return float(hash_bits(x ^ hash_bits(y ^ hash_bits(seed))) >> 8u) * 5.9604644775390625e-8;
}
// [/hash]

// [dither]
// Triangular noise of mean 0 between -1 and 1, in steps of the screen. The difference of two neighbours' uniform noise
// is triangular, and each number is used twice with opposite signs, so that a brighter pixel has a darker neighbour:
// the noise is fine-grained along a row, where the eye sees it least.
float dither_noise(uint x, uint y, uint seed) { return pixel_noise(x + 1u, y, seed) - pixel_noise(x, y, seed); }

// Level 0..255 of an encoded value 0..1. The noise shrinks towards both ends, so black stays black and white white.
float dithered_level(float encoded, float noise) {
  float scaled = 255.0 * encoded;
  float room = min(min(scaled, 255.0 - scaled), 1.0);
  return floor(clamp(scaled + room * noise, 0.0, 255.0) + 0.5);
}
// [/dither]

#endif
