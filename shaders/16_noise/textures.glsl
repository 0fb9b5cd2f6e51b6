// What the textures hold: fBm, Perlin-Worley, curl, and the recipe of every channel. p is a place in the texture, 0 ... 1
// along each side; `cells` is how many cells of the coarsest octave a side has. Everything repeats after 1.
#ifndef WELKIN_NOISE_TEXTURES_GLSL
#define WELKIN_NOISE_TEXTURES_GLSL

#include "16_noise/perlin.glsl"
#include "16_noise/worley.glsl"

const int kBase = 0, kDetail = 1, kCurl = 2, kWeather = 3, kAlligator = 4;

// [fbm]
// Octaves, each twice as fine and `gain` times as strong as the one before, with a seed of its own.
// full: 1 over the sum of the strengths, so that the sum's range is that of one octave.
struct Octaves {
  int count;
  float gain;  // a power of two: products with it are exact
  float full;
};
uint seed_of(uint seed, int octave) { return seed + uint(octave) * 0x9E3779B9u; }

// Every corner of an octave's lattice is one of the next, and Perlin noise is 0 there: the sum of all would be, and the
// corners would show as a grid. So each lattice is moved by a random part of a cell, a multiple of 1/256: exact in float.
vec3 shift_of(uint seed) { return vec3(hashed(ivec3(-1), seed).xyz >> 24u) * (1.0 / 256.0); }

vec4 perlin_fbm(vec3 p, int cells, Octaves octaves, uint seed) {
  precise vec4 sum = vec4(0.0);
  float strength = 1.0;
  for (int i = 0; i < octaves.count; i++, cells *= 2, strength *= octaves.gain) {
    uint own_seed = seed_of(seed, i);
    precise vec3 place = p * float(cells) + shift_of(own_seed);
    vec4 octave = perlin(place, cells, own_seed);
    precise vec4 slopes = octave * vec4(1.0, vec3(float(cells)));  // per side of the texture
    sum = sum + strength * slopes;
  }
  sum = sum * octaves.full;
  return sum;
}

float worley_fbm(vec3 p, int cells, Octaves octaves, uint seed) {
  precise float sum = 0.0;
  float strength = 1.0;
  for (int i = 0; i < octaves.count; i++, cells *= 2, strength *= octaves.gain)
    sum = sum + strength * inverted_worley(p * float(cells), cells, seed_of(seed, i));
  sum = sum * octaves.full;
  return sum;
}
// [/fbm]

vec3 perlin_fbm(vec2 p, int cells, Octaves octaves, uint seed) {
  precise vec3 sum = vec3(0.0);
  float strength = 1.0;
  for (int i = 0; i < octaves.count; i++, cells *= 2, strength *= octaves.gain) {
    uint own_seed = seed_of(seed, i);
    precise vec2 place = p * float(cells) + shift_of(own_seed).xy;
    vec3 octave = perlin(place, cells, own_seed);
    precise vec3 slopes = octave * vec3(1.0, vec2(float(cells)));
    sum = sum + strength * slopes;
  }
  sum = sum * octaves.full;
  return sum;
}

float worley_fbm(vec2 p, int cells, Octaves octaves, uint seed) {
  precise float sum = 0.0;
  float strength = 1.0;
  for (int i = 0; i < octaves.count; i++, cells *= 2, strength *= octaves.gain)
    sum = sum + strength * inverted_worley(p * float(cells), cells, seed_of(seed, i));
  sum = sum * octaves.full;
  return sum;
}

// [perlin_worley]
// Perlin's range 0 ... 1 pushed up to begin at the Worley noise: remap(perlin^2, 0, 1, worley, 1). The result is at least either
// of them ("dilated"): Perlin's connected banks, puffed up with Worley's domes. Squared, because most of Perlin's numbers lie
// near the middle, where they would drown the domes.
float dilated(float perlin, float worley) {
  precise float low = 0.5 + 0.5 * perlin;  // from -1 ... 1
  precise float value = worley + low * low * (1.0 - worley);
  return value;
}
// [/perlin_worley]

// [curl]
// The curl of a vector potential that does not change along z: (d psi_z/dy, -d psi_z/dx, d psi_y/dx - d psi_x/dy). A curl has
// no divergence: what it moves is stirred, never squeezed together or thinned. x and y alone are the 2-D curl of psi_z.
// Derivatives of an octave are twice as strong as those of the one before: with a gain of 1/4 the field's octaves halve.
vec4 curl(vec2 p, int cells, Octaves octaves, uint seed) {
  vec3 x = perlin_fbm(p, cells, octaves, seed);
  vec3 y = perlin_fbm(p, cells, octaves, seed + 1u);
  vec3 z = perlin_fbm(p, cells, octaves, seed + 2u);
  precise float along_z = y.y - x.z;
  return vec4(z.z, -z.y, along_z, z.x);
}

// The same of a potential that changes along all three.
vec3 curl(vec3 p, int cells, Octaves octaves, uint seed) {
  vec4 x = perlin_fbm(p, cells, octaves, seed);
  vec4 y = perlin_fbm(p, cells, octaves, seed + 1u);
  vec4 z = perlin_fbm(p, cells, octaves, seed + 2u);
  precise vec3 field = vec3(z.z - y.w, x.w - z.y, y.y - x.z);
  return field;
}
// [/curl]

// [recipes]
vec4 base_texel(vec3 p, Octaves octaves, uint seed) {
  float low = perlin_fbm(p, 4, octaves, seed).x;
  float domes = worley_fbm(p, 8, octaves, seed + 10u);
  return vec4(dilated(low, domes), inverted_worley(p * 8.0, 8, seed + 20u), inverted_worley(p * 16.0, 16, seed + 30u),
              inverted_worley(p * 32.0, 32, seed + 40u));
}

vec4 detail_texel(vec3 p, uint seed) {
  vec3 octaves = vec3(inverted_worley(p * 2.0, 2, seed), inverted_worley(p * 4.0, 4, seed + 10u), inverted_worley(p * 8.0, 8, seed + 20u));
  precise float sum = 0.5 * octaves.x + 0.25 * octaves.y + 0.125 * octaves.z;
  return vec4(octaves, sum);
}

// Clouds come in fields: coverage is a Perlin-Worley noise, whose domes are single clouds. Height follows it (a wide cloud
// grows tall) with a slow change of its own; type and wetness change slowly over the map.
vec4 weather_texel(vec2 p, Octaves octaves, uint seed) {
  float coverage = dilated(perlin_fbm(p, 4, octaves, seed).x, worley_fbm(p, 8, octaves, seed + 10u));
  float slow = perlin_fbm(p, 2, octaves, seed + 20u).x;
  precise float height = coverage + 0.5 * slow;
  return vec4(coverage, height, perlin_fbm(p, 2, octaves, seed + 30u).x, perlin_fbm(p, 4, octaves, seed + 40u).x);
}

vec4 alligator_texel(vec3 p, uint seed) {
  vec3 octaves = vec3(alligator(p * 4.0, 4, seed), alligator(p * 8.0, 8, seed + 10u), alligator(p * 16.0, 16, seed + 20u));
  precise float sum = 0.5 * octaves.x + 0.25 * octaves.y + 0.125 * octaves.z;
  return vec4(octaves, sum);
}

vec4 texel(int kind, vec3 p, Octaves octaves, uint seed) {
  if (kind == kBase) return base_texel(p, octaves, seed);
  if (kind == kDetail) return detail_texel(p, seed);
  if (kind == kCurl) return curl(p.xy, 4, octaves, seed);
  if (kind == kWeather) return weather_texel(p.xy, octaves, seed);
  return alligator_texel(p, seed);
}
// [/recipes]

#endif
