// What a pixel's ray meets first, terrain or a sign: where, its normal and its albedo. The same functions for the picture
// and for the path tracer's truth. Pure, but for the maps, which the including file gives:
//   vec2 slope_at(vec2 uv)   vec4 cover_at(vec2 uv)   vec4 sign_place(int k)
#ifndef WELKIN_SURFACE_GLSL
#define WELKIN_SURFACE_GLSL

#include "11_aerial_perspective/ground.glsl"
#include "11_aerial_perspective/signs.glsl"

const float kNoDetail = 1.0e6;  // a pixel so wide that it shows none

struct Surface {
  float t_km;
  bool is_terrain;
  vec2 place_km;
  vec3 up;         // there
  vec3 normal;     // towards the eye
  vec3 albedo;
};

// [surfaces_seen]
// The terrain at a distance along a ray. pixel: how wide one is at a distance of 1.
Surface terrain_surface(float ground_radius_km, float extent_km, vec3 bare, vec3 start_km, vec3 direction, float t_km,
                        float pixel) {
  Surface surface;
  surface.t_km = t_km;
  surface.is_terrain = true;
  surface.place_km = place_below(ground_radius_km, start_km + direction * t_km);
  surface.up = up_at(ground_radius_km, surface.place_km);
  vec2 uv = map_uv(surface.place_km, extent_km);
  vec2 slope = slope_at(uv);
  // Seen at a low angle a pixel is long; between its width and its length lies what it may show.
  vec3 level = normalize(surface.up - vec3(slope.x, slope.y, 0.0));
  float facing = max(-dot(level, direction), 0.02);
  Ground ground = ground_at(slope, cover_at(uv), bare, surface.place_km, surface.up, t_km * pixel / sqrt(facing));
  surface.normal = ground.normal;
  surface.albedo = ground.albedo;
  return surface;
}

// The nearest sign before t_km, and the share of the pixel that it covers: 0 if there is none.
struct SignSeen {
  Surface surface;
  float share;
};

SignSeen sign_before(float ground_radius_km, vec3 start_km, vec3 direction, float t_km, float pixel) {
  SignSeen seen;
  seen.surface.t_km = t_km;
  seen.surface.is_terrain = false;
  seen.share = 0.0;
  for (int k = 0; k < kSigns; k++) {
    SignBoard sign = sign_board(sign_place(k), ground_radius_km);
    SignHit hit = meet_sign(sign, k, ground_radius_km, start_km, direction, pixel);
    if (hit.t_km < 0.0 || hit.t_km >= seen.surface.t_km) continue;
    seen.share = hit.share;
    seen.surface.t_km = hit.t_km;
    seen.surface.normal = dot(hit.normal, direction) > 0.0 ? hit.normal * -1.0 : hit.normal;
    seen.surface.albedo = vec3(hit.paint, hit.paint, hit.paint);
  }
  if (seen.share <= 0.0) return seen;
  seen.surface.place_km = place_below(ground_radius_km, start_km + direction * seen.surface.t_km);
  seen.surface.up = up_at(ground_radius_km, seen.surface.place_km);
  return seen;
}
// [/surfaces_seen]

#endif
