// What the compute passes of chapter 11 share: constants compiled in, the push block, the table of chapter 09 and the
// terrain's shadow. Bindings 0 to 2.
#ifndef WELKIN_AERIAL_BLOCK_GLSL
#define WELKIN_AERIAL_BLOCK_GLSL

#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "11_aerial_perspective/terrain.glsl"

layout(constant_id = 16) const bool HIGHER_ORDERS = true;  // 0 to 6: chapters 04 and 09
layout(constant_id = 17) const bool HAS_SHADOWS = true;
layout(constant_id = 18) const bool HAS_COLOUR = true;     // transmittance per channel, or its mean
layout(constant_id = 19) const int SLICES = 32;
layout(constant_id = 20) const int SAMPLES = 2;
layout(constant_id = 21) const float POWER = 2.0;

layout(binding = 1) uniform sampler2D multiple_scattering_table;
layout(binding = 2) uniform sampler2D shadow_map;
layout(push_constant) uniform Push {
  float extent_km;    // of the map
  float farthest_km;  // froxel
#ifdef WELKIN_WITH_SIGNS
  vec4 sign_places[7];  // see signs.glsl
#endif
};

vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(multiple_scattering_table, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"

// The ray that the next call of the march is about, in the global frame.
vec3 ray_start_km;
vec3 ray_direction;

// [sun_behind_terrain]
// The shadow map says for every place from which altitude on the sun is seen, how wide the half shadow is, and how high
// the ground. The ground itself asks how far that altitude is above the ground there: heights of one map, filtered in one
// way. With
// its own altitude, which is known finer, it would be in shadow wherever it lies lower than between two texels.
vec3 shadow_at(vec2 place_km) { return textureLod(shadow_map, map_uv(place_km, extent_km), 0.0).rgb; }

float sun_over(vec2 place_km, float altitude_km) {
  if (!HAS_SHADOWS) return 1.0;
  const vec3 shadow = shadow_at(place_km);
  return disc_above((altitude_km - shadow.x) / shadow.y);
}

float sun_on_ground(vec2 place_km) {
  if (!HAS_SHADOWS) return 1.0;
  const vec3 shadow = shadow_at(place_km);
  return disc_above((shadow.z - shadow.x) / shadow.y);
}

float sun_behind_terrain(float t_km, float altitude_km) {
  if (!HAS_SHADOWS) return 1.0;
  return sun_over(place_below(atmosphere.ground_radius_km, ray_start_km + ray_direction * t_km), altitude_km);
}
// [/sun_behind_terrain]

#include "11_aerial_perspective/aerial.glsl"

vec3 to_global(vec3 local) {
  return frame.east * local.x + frame.north * local.y + cross(frame.east, frame.north) * local.z;
}

// Sets the ray of sun_behind_terrain() and clips it to the air; gives how far away that begins.
struct ClippedRay {
  AirRay air;
  float begins_km;
};
ClippedRay clipped_ray(vec3 view, float altitude_km) {
  ClippedRay ray;
  ray.air = enter_air(atmosphere, altitude_km, view, frame.camera.sun);
  ray.begins_km = 0.0;
  if (altitude_km > atmosphere.top_km)
    ray.begins_km = max(distance_to_shell_from_outside(atmosphere.ground_radius_km, altitude_km, view.z,
                                                       length(view.xy), atmosphere.top_km), 0.0);
  ray_direction = to_global(view);
  ray_start_km = frame.position_km + ray_direction * ray.begins_km;
  return ray;
}

#endif
