// What the terrain is made of and how light leaves it. Pure functions; lengths in km, global frame.
#ifndef WELKIN_GROUND_GLSL
#define WELKIN_GROUND_GLSL

#include "11_aerial_perspective/detail.glsl"
#include "11_aerial_perspective/terrain.glsl"

struct Ground {
  vec3 albedo;
  vec3 normal;
};

// [ground]
// A share of cover as a map with borders: where the noise is above what the share asks for. Blurred where detail is.
float bordered(float share, float rough, float sharp) {
  float blur = 0.5 - 0.42 * sharp;
  return smoothstep(0.5 - blur, 0.5 + blur, share + rough);
}

// Albedo and normal. cover: share of grass, rock, snow and bare ground; bare: the planet's albedo.
Ground ground_at(vec2 slope, vec4 cover, vec3 bare, vec2 place_km, vec3 up, float footprint_km) {
  Detail detail = detail_at(place_km, footprint_km);
  float total = max(cover.x + cover.y + cover.z + cover.w, 1.0e-6);
  float rough = detail.patches + 0.5 * detail.grain;
  float rock = bordered(cover.y / total, 0.7 * rough, detail.sharp);
  float snow = bordered(cover.z / total, 0.7 * rough, detail.sharp);
  float soil = cover.w / total;
  // Meadow: green in the hollows, straw where it is dry, dark shrubs, and limestone that looks out of it.
  float dry = smoothstep(-0.25, 0.25, detail.patches + 0.3 * detail.grain);
  float shrub = smoothstep(0.10, 0.10 + 0.3 - 0.2 * detail.sharp, -rough - 0.05);
  float stone = smoothstep(0.16, 0.22, detail.grain + 0.3 * detail.patches);
  vec3 grass = mix(mix(vec3(0.070, 0.095, 0.032), vec3(0.165, 0.140, 0.065), dry), vec3(0.028, 0.042, 0.016), shrub);
  grass = mix(grass, vec3(0.21, 0.195, 0.17), stone * (1.0 - shrub));
  vec3 cliff = mix(vec3(0.13, 0.117, 0.105), vec3(0.27, 0.25, 0.22), smoothstep(-0.3, 0.3, rough));
  vec3 mixed = mix(grass * clamp(1.0 + 1.2 * detail.grain, 0.5, 1.4), bare, soil);
  mixed = mix(mixed, cliff * clamp(1.0 + 1.2 * detail.grain, 0.5, 1.4), rock);
  mixed = mix(mixed, vec3(0.80, 0.82, 0.85) * (1.0 + 0.1 * detail.grain), snow);
  Ground ground;
  ground.albedo = clamp(mixed, 0.0, 0.95);
  vec2 tilt = slope + detail.tilt * (kSteepness * mix(1.0, 1.6, rock) * (1.0 - 0.6 * snow));
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
