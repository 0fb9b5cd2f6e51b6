// What a pixel's ray meets first, terrain or a sign: where, its normal and its albedo. One function for the picture and for the
// path tracer's truth. Pure, but for the maps, which the including file gives:
//   vec2 slope_at(vec2 uv)   vec4 cover_at(vec2 uv)
#ifndef WELKIN_SURFACE_GLSL
#define WELKIN_SURFACE_GLSL

#include "11_aerial_perspective/ground.glsl"
#include "11_aerial_perspective/signs.glsl"

struct Surface {
  float t_km;      // 0: nothing is met
  bool is_terrain;
  vec2 place_km;
  vec3 up;         // there
  vec3 normal;     // towards the eye
  vec3 albedo;
};

// [first_surface]
// terrain_km: distance of the terrain along the ray, 0 without; signs_azimuth_rad below -100 without signs; pixel: how wide one is
// at a distance of 1.
Surface first_surface(float ground_radius_km, float extent_km, vec3 bare, vec3 start_km, vec3 direction, float terrain_km,
                      float signs_azimuth_rad, float pixel) {
  Surface surface;
  surface.t_km = terrain_km;
  surface.is_terrain = terrain_km > 0.0;
  surface.normal = vec3(0.0, 0.0, 1.0);
  surface.albedo = vec3(0.0, 0.0, 0.0);
  if (signs_azimuth_rad > -100.0) {
    for (int k = 0; k < kSigns; k++) {
      SignHit hit = meet_sign(k, ground_radius_km, signs_azimuth_rad, start_km, direction);
      if (hit.t_km < 0.0 || (surface.t_km > 0.0 && hit.t_km >= surface.t_km)) continue;
      surface.t_km = hit.t_km;
      surface.is_terrain = false;
      surface.normal = dot(hit.normal, direction) > 0.0 ? hit.normal * -1.0 : hit.normal;
      surface.albedo = vec3(hit.paint, hit.paint, hit.paint);
    }
  }
  surface.place_km = place_below(ground_radius_km, start_km + direction * surface.t_km);
  surface.up = up_at(ground_radius_km, surface.place_km);
  if (surface.is_terrain) {
    vec2 uv = map_uv(surface.place_km, extent_km);
    vec2 slope = slope_at(uv);
    // Seen at a low angle a pixel is long; between its width and its length lies what it may show.
    vec3 level = normalize(surface.up - vec3(slope.x, slope.y, 0.0));
    float facing = max(-dot(level, direction), 0.02);
    float footprint_km = surface.t_km * pixel / sqrt(facing);
    Ground ground = ground_at(slope, cover_at(uv), bare, surface.place_km, surface.up, footprint_km);
    surface.normal = ground.normal;
    surface.albedo = ground.albedo;
  }
  return surface;
}
// [/first_surface]

#endif
