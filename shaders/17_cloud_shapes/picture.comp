// The clouds before sky and terrain, as far as this chapter knows them: what they let through, and a grey that rises with
// height in place of light, which is chapter 18's. Knob cloud.show: transmittance, or optical depth on a colour scale.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "03_planet_and_rays/picture.glsl"
#define CLOUD_BINDING 0
#include "17_cloud_shapes/block.glsl"

layout(constant_id = 41) const bool HAS_TERRAIN = false;

layout(binding = 6, rgba32f) uniform readonly image2D behind;
layout(binding = 7, rgba32f) uniform readonly image2D terrain_distance;  // `behind` where there is no terrain
layout(binding = 8, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  int steps, detail, grid_method, grid_steps;
  vec4 white;  // rgb: radiance of the brightest cloud; w: 1 moves every pixel's samples by its own share of a step
  int show_depth;
};

// 0 ... 1, another for every pixel: hashed as in chapter 16.
float pixel_share(ivec2 pixel) {
  uint h = uint(pixel.x) * 0x9E3779B1u ^ uint(pixel.y) * 0x85EBCA77u;
  h ^= h >> 15, h *= 0x2C1B3C6Du, h ^= h >> 12, h *= 0x297A2D39u, h ^= h >> 15;
  return float(h >> 8) / 16777216.0;
}

// [painted]
// Optical depth, share of light stopped, and that weighted by height and distance, of one body.
vec4 painted(CloudBody body, CloudRay ray, CloudMarch march) {
  const float radius = clouds.ground_radius_km;
  if (body.kind == kCloudNoise || body.kind == kCloudGrid) {
    const Spans spans = body_spans(body, radius, ray);
    vec4 first = marched_column(body, radius, ray, spans.first, march);
    const float through = exp(-body.extinction_per_km * first.x);
    const vec4 second = marched_column(body, radius, ray, spans.second, march);
    first += vec4(second.x, second.yzw * through);
    first.x *= body.extinction_per_km;
    return first;
  }
  const float depth = body_optical_depth(body, radius, ray, march);
  const Spans spans = body_spans(body, radius, ray);
  const float enters = span_length(spans.first) > 0.0 ? spans.first.x : spans.second.x, stopped = 1.0 - exp(-depth);
  const float height = (altitude_along(radius, ray.altitude_km, ray.mu, enters) - body.base_km) / (body.top_km - body.base_km);
  return vec4(depth, stopped, stopped * clamp(height, 0.0, 1.0), stopped * enters);
}
// [/painted]

// [picture]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const vec3 view = camera_direction(frame.camera, pixel);
  const float sine = length(view.xy), radius = clouds.ground_radius_km;
  CloudRay ray = CloudRay(frame.position_km, frame.position_rest_km, frame.east * view.x + frame.north * view.y + cross(frame.east, frame.north) * view.z,
                          frame.camera.altitude_km, view.z, sine, 0.0, ground_end(radius, frame.camera.altitude_km, view.z, sine));
  if (HAS_TERRAIN) {
    const float terrain = imageLoad(terrain_distance, pixel).x;
    if (terrain > 0.0) ray.end_km = terrain;
  }
  ray = below_ceiling(radius, clouds.ceiling_km, ray);
  const CloudMarch march = CloudMarch(steps, detail, grid_method, grid_steps, white.w > 0.5 ? pixel_share(pixel) : 0.5);
  vec4 all = vec4(0.0);
  if (ray.end_km > 0.0)
    for (int i = 0; i < clouds.count; i++) all += painted(clouds.bodies[i], ray, march);
  const vec3 sky = imageLoad(behind, pixel).rgb;
  const float share = 1.0 - exp(-all.x), height = all.z / max(all.y, 1.0e-6), distance_km = all.w / max(all.y, 1.0e-6);
  // A stand-in for the air before a cloud, until chapter 19: towards the colour behind it, by 1/e after 80 km below the ceiling.
  vec3 cloud = mix(sky, white.rgb * mix(0.25, 1.0, smoothstep(0.0, 0.45, height)), exp(-distance_km / 80.0));
  if (show_depth == 1) cloud = white.rgb * scale_colour(on_log_scale(all.x, 0.01, 4.0));
  imageStore(target, pixel, vec4(mix(sky, cloud, show_depth == 1 ? step(0.01, all.x) : share), 1.0));
}
// [/picture]
