// What each pixel's ray meets first, for chapter 07's path tracer: distance, normal and albedo of terrain and signs, as
// compose.glsl finds them: by the same function. km; the global frame, but normals in that of the eye.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"

layout(constant_id = 0) const bool HAS_SIGNS = true;
layout(constant_id = 1) const float EXTENT_KM = 128.0;
layout(constant_id = 2) const float RADIUS_KM = 6360.0;
layout(constant_id = 3) const bool HAS_DETAIL = true;

layout(binding = 0, rgba32f) uniform readonly image2D terrain_distance;
layout(binding = 1) uniform sampler2D slope_map;
layout(binding = 2) uniform sampler2D cover_map;
layout(binding = 3, rgba32f) uniform writeonly image2D normals;  // w: distance, 0: nothing is met
layout(binding = 4, rgba32f) uniform writeonly image2D albedos;
layout(push_constant) uniform Push {
  vec4 bare_albedo;      // rgb: of the bare ground
  vec4 sign_places[7];  // see signs.glsl
};

vec2 slope_at(vec2 uv) { return textureLod(slope_map, uv, 0.0).rg; }
vec4 cover_at(vec2 uv) { return textureLod(cover_map, uv, 0.0); }
vec4 sign_place(int k) { return sign_places[k]; }
#include "11_aerial_perspective/surface.glsl"

// [surfaces]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const vec3 view = camera_direction(frame.camera, pixel);
  const vec3 above = cross(frame.east, frame.north);
  const vec3 direction = frame.east * view.x + frame.north * view.y + above * view.z;
  const float pixel_rad = 2.0 * length(frame.camera.up) / float(frame.camera.size.y);
  const vec4 terrain = imageLoad(terrain_distance, pixel);
  bool seen = terrain.x > 0.0;
  Surface surface;
  if (seen)
    surface = terrain_surface(RADIUS_KM, EXTENT_KM, bare_albedo.rgb, frame.position_km, direction, terrain.x,
                              HAS_DETAIL ? pixel_rad : kNoDetail);
  if (HAS_SIGNS) {
    const SignSeen sign = sign_before(RADIUS_KM, frame.position_km, direction, seen ? terrain.x : 1.0e9, pixel_rad);
    if (sign.share > 0.5) surface = sign.surface, seen = true;  // a path meets one surface or the other
  }
  const vec3 local =
      vec3(dot(surface.normal, frame.east), dot(surface.normal, frame.north), dot(surface.normal, above));
  imageStore(normals, pixel, seen ? vec4(local, surface.t_km) : vec4(0.0));
  imageStore(albedos, pixel, seen ? vec4(surface.albedo, 1.0) : vec4(0.0));
}
// [/surfaces]
