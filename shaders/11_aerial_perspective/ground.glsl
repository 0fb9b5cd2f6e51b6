// What the terrain is made of and how light leaves it. Pure functions; lengths in km, global frame.
#ifndef WELKIN_GROUND_GLSL
#define WELKIN_GROUND_GLSL

#include "11_aerial_perspective/terrain.glsl"

struct Ground {
  vec3 albedo;
  vec3 normal;
};

// Numbers from whole numbers, the same on every device.
float lattice(int i, int j) {
  uint h = uint(i) * 0x9E3779B1u ^ uint(j) * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  return float(h >> 8) * (1.0 / 16777216.0);
}

// Value noise, 0 ... 1, and its derivatives: (value, d/dx, d/dy).
vec3 value_noise(vec2 at) {
  vec2 cell = floor(at);
  int i = int(cell.x);
  int j = int(cell.y);
  float u = at.x - cell.x;
  float v = at.y - cell.y;
  float a = u * u * (3.0 - 2.0 * u);
  float b = v * v * (3.0 - 2.0 * v);
  float c00 = lattice(i, j);
  float c10 = lattice(i + 1, j);
  float c01 = lattice(i, j + 1);
  float c11 = lattice(i + 1, j + 1);
  float low = c00 + a * (c10 - c00);
  float high = c01 + a * (c11 - c01);
  float across = (c10 - c00) + b * ((c11 - c01) - (c10 - c00));
  return vec3(low + b * (high - low), 6.0 * u * (1.0 - u) * across, 6.0 * v * (1.0 - v) * (high - low));
}

// [ground]
// Albedo and normal. cover: share of grass, rock, snow and bare ground. Between the map's samples, 125 m apart, noise of
// five scales stands in for what the map does not hold; each scale is left out where a pixel (pixel_km at that distance)
// covers its waves, so that far slopes do not sparkle.
Ground ground_at(vec2 slope, vec4 cover, vec3 bare, vec2 place_km, vec3 up, float pixel_km) {
  float tone = 0.0;
  vec2 tilt = slope;
  float wave_km = 0.16;
  for (int octave = 0; octave < 5; octave++) {
    float kept = clamp(1.5 - 3.0 * pixel_km / wave_km, 0.0, 1.0);
    if (kept > 0.0) {
      vec3 rough = value_noise(place_km / wave_km + vec2(17.0 * float(octave), 5.0));
      tone += kept * (rough.x - 0.5);
      float steep = 0.05 + 0.12 * cover.y;
      tilt += vec2(rough.y, rough.z) * (kept * steep);
    }
    wave_km *= 0.23;
  }
  float total = max(cover.x + cover.y + cover.z + cover.w, 1.0e-6);
  vec3 grass = vec3(0.085, 0.110, 0.042);
  vec3 rock = vec3(0.150, 0.135, 0.120);
  vec3 snow = vec3(0.80, 0.82, 0.85);
  Ground ground;
  vec3 mixed = (grass * cover.x + rock * cover.y + snow * cover.z + bare * cover.w) / total;
  ground.albedo = mixed * clamp(1.0 + tone * (0.5 - 0.4 * cover.z), 0.3, 1.15);
  // East and north of the map, laid on the sphere.
  vec3 east = normalize(vec3(up.z, 0.0, -up.x));
  vec3 north = cross(up, east);
  ground.normal = normalize(up - east * tilt.x - north * tilt.y);
  return ground;
}
// [/ground]

// [surface_light]
// Radiance of a Lambert surface: the sun's beam, the sky over the part of the hemisphere that is sky, and level ground,
// lit by both, over the part that is not. A slope sees (1 + cos)/2 of the sky; the sky is taken as even.
vec3 surface_light(vec3 albedo, vec3 around, vec3 normal, vec3 up, vec3 sun, vec3 beam, vec3 from_sky) {
  float open = 0.5 + 0.5 * dot(normal, up);
  vec3 level = beam * max(dot(sun, up), 0.0) + from_sky;
  vec3 irradiance = beam * max(dot(normal, sun), 0.0) + from_sky * open + around * level * (1.0 - open);
  return albedo * irradiance * 0.31830988618379067;
}
// [/surface_light]

#endif
