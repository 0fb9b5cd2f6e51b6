// The clouds before sky and terrain, lit by the sun: the march of chapter 18 for each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "18_cloud_light/scene_block.glsl"
#include "18_cloud_light/march_push.glsl"

layout(constant_id = 41) const bool HAS_TERRAIN = false;

layout(binding = 7, rgba32f) uniform readonly image2D behind;
layout(binding = 8, rgba32f) uniform readonly image2D terrain_distance;  // `behind` where there is no terrain
layout(binding = 9, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  CloudLightPush march;
  vec4 sunlight;  // rgb: irradiance at the clouds
};

// 0 ... 1, another for every pixel.
float pixel_share(ivec2 pixel) {
  uint h = uint(pixel.x) * 0x9E3779B1u ^ uint(pixel.y) * 0x85EBCA77u;
  h ^= h >> 15, h *= 0x2C1B3C6Du, h ^= h >> 12, h *= 0x297A2D39u, h ^= h >> 15;
  return float(h >> 8) / 16777216.0;
}

// [light]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const vec3 view = camera_direction(frame.camera, pixel), up = cross(frame.east, frame.north);
  const float sine = length(view.xy), radius = clouds.ground_radius_km;
  CloudRay ray = CloudRay(frame.position_km, frame.position_rest_km, frame.east * view.x + frame.north * view.y + up * view.z, frame.camera.altitude_km,
                          view.z, sine, 0.0, ground_end(radius, frame.camera.altitude_km, view.z, sine));
  if (HAS_TERRAIN) {
    const float terrain = imageLoad(terrain_distance, pixel).x;
    if (terrain > 0.0) ray.end_km = terrain;
  }
  ray = below_ceiling(radius, clouds.ceiling_km, ray);
  const vec3 sky = imageLoad(behind, pixel).rgb;
  vec3 result = sky;
  if (ray.end_km > 0.0) {
    CloudMarchSettings settings = march_settings(march);
    const vec3 sun = frame.camera.sun;
    settings.sun = frame.east * sun.x + frame.north * sun.y + up * sun.z;
    settings.offset = pixel_share(pixel);
    const CloudLight light = march_cloud_light(ray, settings);
    result = sky * exp(-light.tau) + sunlight.rgb * light.radiance;
  }
  imageStore(target, pixel, vec4(result, 1.0));
}
// [/light]
