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
// Turns a share of cover into patches with borders: cover lies where share plus noise is above 1/2. The fewer scales of
// detail are kept (sharp, 0 ... 1), the more the borders are blurred.
float bordered(float share, float rough, float sharp) {
  float blur = 0.5 - 0.42 * sharp;
  return smoothstep(0.5 - blur, 0.5 + blur, share + rough);
}

// Albedo and normal. cover: share of grass, rock, snow and bare ground; bare: the planet's albedo.
Ground ground_at(vec2 slope, vec4 cover, vec3 bare, vec2 place_km, vec3 up, float footprint_km) {
  Detail detail = detail_at(place_km, footprint_km);
  float total = max(cover.x + cover.y + cover.z + cover.w, 1.0e-6);
  float rough = detail.patches + 0.5 * detail.grain + 0.25 * detail.blades;
  float rock = bordered(cover.y / total, 0.8 * rough, detail.sharp);
  float snow = bordered(cover.z / total, 0.8 * rough, detail.sharp);
  float soil = cover.w / total;
  // Meadow: green in the hollows, straw where it is dry, dark shrubs, and stones between.
  float dry = smoothstep(-0.28, 0.28, detail.patches + 0.6 * detail.grain + 0.5 * detail.blades);
  float shrub = smoothstep(0.06, 0.06 + 0.3 - 0.2 * detail.sharp,
                           -0.5 * detail.patches - 0.8 * detail.grain - 0.3 * detail.blades);
  float stone = smoothstep(0.30, 0.40, detail.grain + 0.35 * detail.blades - 0.5 * detail.patches);
  vec3 grass = mix(mix(vec3(0.066, 0.086, 0.030), vec3(0.150, 0.126, 0.062), dry), vec3(0.036, 0.050, 0.022), shrub);
  grass *= clamp(1.0 + 1.6 * detail.blades + 0.5 * detail.grain, 0.35, 1.6);
  vec3 limestone = vec3(0.205, 0.190, 0.168) * clamp(1.0 + 1.2 * detail.blades, 0.5, 1.3);
  grass = mix(grass, limestone, stone * (1.0 - shrub));
  vec3 cliff = mix(vec3(0.120, 0.108, 0.096), vec3(0.235, 0.217, 0.190), smoothstep(-0.3, 0.3, rough));
  cliff *= clamp(1.0 + 0.8 * detail.grain + detail.blades, 0.5, 1.4);
  vec3 mixed = mix(mix(grass, bare, soil), cliff, rock);
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
