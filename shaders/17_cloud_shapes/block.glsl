// Bodies of cloud and their textures, bound: for every entry point that asks for clouds. It defines the first of six
// bindings that are free, #define CLOUD_BINDING n. Names as chapters/17_cloud_shapes/clouds.hpp binds them; what a scene
// does not have is a texel that nobody reads.
#ifndef WELKIN_CLOUD_BLOCK_GLSL
#define WELKIN_CLOUD_BLOCK_GLSL

#include "interop/cloud.h"

layout(constant_id = 40) const int CLOUD_KINDS = 31;  // bits of interop/cloud.h: kinds that are there

layout(binding = CLOUD_BINDING, std140) uniform Clouds {
  CloudBlock clouds;
};
layout(binding = CLOUD_BINDING + 1) uniform sampler3D cloud_grids;
layout(binding = CLOUD_BINDING + 2) uniform sampler2D weather_map;
layout(binding = CLOUD_BINDING + 3) uniform sampler3D noise_base;
layout(binding = CLOUD_BINDING + 4) uniform sampler3D noise_detail;
layout(binding = CLOUD_BINDING + 5) uniform sampler2D noise_curl;

float grid_texel(int i, int j, int k) { return texelFetch(cloud_grids, ivec3(i, j, k), 0).r; }
float grid_filtered(vec3 texel) { return textureLod(cloud_grids, texel / vec3(textureSize(cloud_grids, 0)), 0.0).r; }
vec4 weather_texel(vec2 uv) { return textureLod(weather_map, uv, 0.0); }
vec4 base_noise(vec3 uvw) { return textureLod(noise_base, uvw, 0.0); }
vec4 detail_noise(vec3 uvw) { return textureLod(noise_detail, uvw, 0.0); }
vec4 curl_noise(vec2 uv) { return textureLod(noise_curl, uv, 0.0); }

#include "17_cloud_shapes/optical_depth.glsl"

// [all_bodies]
// Extinction at a point, 1/km, and optical depth along a ray, of all bodies: they add up.
float cloud_extinction(CloudPoint point, int detail, int grid_method) {
  float sum = 0.0;
  for (int i = 0; i < clouds.count; i++)
    sum += clouds.bodies[i].extinction_per_km * cloud_density(clouds.bodies[i], clouds.ground_radius_km, point, detail, grid_method);
  return sum;
}

float cloud_optical_depth(CloudRay ray, CloudMarch march) {
  float sum = 0.0;
  const CloudRay below = below_ceiling(clouds.ground_radius_km, clouds.ceiling_km, ray);
  if (below.end_km > 0.0)
    for (int i = 0; i < clouds.count; i++) sum += body_optical_depth(clouds.bodies[i], clouds.ground_radius_km, below, march);
  return sum;
}
// [/all_bodies]

#endif
