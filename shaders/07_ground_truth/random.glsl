// Random numbers that are a pure function of what they are for: (path, sample, seed, how many were drawn before).
//
// A counter is hashed by pcg4d (Jarzynski and Olano 2020), a permutation of 128 bits: the same on every device, no
// state kept between frames, and no two paths share a stretch of one sequence, as they would with a seeded generator of
// 2^32 states. fract(sin()) has none of these properties. Pure functions, also valid C++.
#ifndef WELKIN_RANDOM_GLSL
#define WELKIN_RANDOM_GLSL

// [random]
struct Random {
  uvec4 key;   // x: path (pixel or ray), y: sample, z: seed, w: draws so far
  vec4 value;  // four independent numbers, each in (0, 1)
};

uvec4 pcg4d(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v = v ^ (v >> 16u);
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

Random random_stream(uint path, uint number, uint seed) {
  Random random;
  random.key = uvec4(path, number, seed, 0u);
  random.value = vec4(0.5, 0.5, 0.5, 0.5);
  return random;
}

// The next four, of 24 bits each, in the middle of their steps: never 0. The last middle would round to 1; min() keeps
// it below.
Random draw(Random random) {
  uvec4 bits = pcg4d(random.key) >> 8u;
  random.value =
      min((vec4(bits) + 0.5) * 5.9604644775390625e-8, vec4(0.99999994, 0.99999994, 0.99999994, 0.99999994));
  random.key.w += 1u;
  return random;
}
// [/random]

#endif
