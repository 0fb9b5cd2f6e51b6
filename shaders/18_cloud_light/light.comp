// The clouds before sky and terrain, lit by sun, sky and ground: the march of chapter 18 for each pixel. The air between eye
// and cloud is chapter 19's.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
layout(binding = 8) uniform sampler2D multiple_scattering_table;  // any map where there is no air
vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(multiple_scattering_table, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"
#define CLOUD_WITH_AIR
#define CLOUD_BINDING 1
#include "07_ground_truth/flight.glsl"
#include "18_cloud_light/scene_block.glsl"
#include "18_cloud_light/march_push.glsl"

layout(constant_id = 41) const bool HAS_TERRAIN = false;
layout(constant_id = 42) const bool HAS_AIR = false;

layout(binding = 9, rgba32f) uniform readonly image2D behind;
layout(binding = 10, rgba32f) uniform readonly image2D terrain_distance;  // `behind` where there is no terrain
layout(binding = 11, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  CloudLightPush march;
  vec4 sunlight;  // rgb: irradiance above the air
};

// 0 ... 1, another for every pixel.
float pixel_share(ivec2 pixel) {
  uint h = uint(pixel.x) * 0x9E3779B1u ^ uint(pixel.y) * 0x85EBCA77u;
  h ^= h >> 15, h *= 0x2C1B3C6Du, h ^= h >> 12, h *= 0x297A2D39u, h ^= h >> 15;
  return float(h >> 8) / 16777216.0;
}

// [light_around]
// Per unit of the sun's irradiance: sunlight that reaches an altitude, mean radiance of the sky there and of the ground below.
// Clouds do not shade the ground nor brighten the sky yet.
struct LightAround {
  vec3 sun;
  vec3 sky;
  vec3 ground;
};

LightAround light_around(Atmosphere air, float altitude_km, float mu_sun) {
  LightAround around = LightAround(vec3(1.0), vec3(0.0), air.ground_albedo * max(mu_sun, 0.0) * 0.31830988618379067);
  if (!HAS_AIR) return around;
  const bool up = sun_above_horizon(air.ground_radius_km, altitude_km, mu_sun);
  around.sun = up ? exp(-extinction(air, sun_columns(air, altitude_km, mu_sun))) : vec3(0.0);
  around.sky = sky_irradiance(air, altitude_km, mu_sun) * 0.31830988618379067;
  vec3 on_ground = sky_irradiance(air, 0.0, mu_sun);
  if (mu_sun > 0.0) on_ground += mu_sun * exp(-extinction(air, sun_columns(air, 0.0, mu_sun)));
  around.ground = air.ground_albedo * on_ground * 0.31830988618379067;
  return around;
}
// [/light_around]

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
    const float stops_at = light.stopped_at_km / max(light.stopped, 1.0e-6);
    const float altitude = clamp(altitude_along(radius, ray.altitude_km, ray.mu, stops_at), 0.0, clouds.ceiling_km);
    const LightAround around = light_around(atmosphere, altitude, sun.z);
    const vec3 scattered = around.sun * light.radiance + around.sky * light.skylight.x + around.ground * light.skylight.y;
    // What kept its direction more or less is taken as unblurred: the sky behind a fringe is brighter at the horizon than in the mean.
    result = sky * (exp(-light.tau) + light.blurred) + sunlight.rgb * scattered;
  }
  imageStore(target, pixel, vec4(result, 1.0));
}
// [/light]
