// What each pixel's ray meets first, for chapter 07's path tracer: distance, normal and albedo of terrain and signs, found as
// compose.glsl finds them. km; the global frame, but normals in that of the eye.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "11_aerial_perspective/ground.glsl"
#include "11_aerial_perspective/signs.glsl"

layout(constant_id = 0) const bool HAS_SIGNS = true;
layout(constant_id = 1) const float SIGNS_AZIMUTH = 0.0;  // rad
layout(constant_id = 2) const float NEAR_KM = 1.0e-4;
layout(constant_id = 3) const float EXTENT_KM = 128.0;
layout(constant_id = 4) const float RADIUS_KM = 6360.0;

layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform sampler2D slope_map;
layout(binding = 2) uniform sampler2D cover_map;
layout(binding = 3, rgba32f) uniform writeonly image2D normals;  // w: distance, 0: nothing is met
layout(binding = 4, rgba32f) uniform writeonly image2D albedos;
layout(push_constant) uniform Push {
  vec4 bare_albedo;  // rgb: of the bare ground
};

// [surfaces]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const vec3 view = camera_direction(frame.camera, pixel);
  const vec3 above = cross(frame.east, frame.north);
  const vec3 direction = frame.east * view.x + frame.north * view.y + above * view.z;

  const float depth = texelFetch(depth_map, pixel, 0).r;
  bool seen = depth > 0.0;
  float t_km = seen ? distance_from_depth(depth, NEAR_KM, dot(view, normalize(frame.camera.forward))) : 1.0e9;
  float paint = -1.0;
  vec3 normal = vec3(0.0);
  if (HAS_SIGNS) {
    for (int k = 0; k < kSigns; ++k) {
      const SignHit hit = meet_sign(k, RADIUS_KM, SIGNS_AZIMUTH, frame.position_km, direction);
      if (hit.t_km < 0.0 || hit.t_km >= t_km) continue;
      t_km = hit.t_km, paint = hit.paint, normal = hit.normal, seen = true;
    }
  }
  vec3 albedo = vec3(paint);
  if (seen && paint < 0.0) {
    const vec2 place = place_below(RADIUS_KM, frame.position_km + direction * t_km);
    const vec2 uv = map_uv(place, EXTENT_KM);
    const vec3 bare = bare_albedo.rgb;
    const Ground ground = ground_at(textureLod(slope_map, uv, 0.0).rg, textureLod(cover_map, uv, 0.0), bare, place, up_at(RADIUS_KM, place), t_km / float(frame.camera.size.y));
    albedo = ground.albedo, normal = ground.normal;
  } else if (dot(normal, direction) > 0.0) {
    normal = -normal;
  }
  const vec3 local = vec3(dot(normal, frame.east), dot(normal, frame.north), dot(normal, above));
  imageStore(normals, pixel, seen ? vec4(local, t_km) : vec4(0.0));
  imageStore(albedos, pixel, vec4(albedo, 1.0));
}
// [/surfaces]
