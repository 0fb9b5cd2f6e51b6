// Densities of the first body, shape alone, with detail, with curled detail; and the extinction of all. Item: origin and
// altitude, offset and nothing. Item 0 ... textures: texels of the noise, as the double twin reads them.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define CLOUD_BINDING 0
#include "17_cloud_shapes/block.glsl"

layout(binding = 6, std430) readonly buffer Points { vec4 points[]; };
layout(binding = 7, std430) writeonly buffer Results { vec4 results[]; };
layout(push_constant) uniform Push { int count, texture_read, grid_method; };

void main() {
  const int item = int(gl_GlobalInvocationID.x);
  if (item >= count) return;
  if (texture_read == 0) {
    const CloudPoint point = CloudPoint(points[2 * item].xyz, points[2 * item + 1].xyz, points[2 * item].w);
    vec4 answer = vec4(0.0);
    for (int detail = 0; detail < 3; detail++)
      answer[detail] = cloud_density(clouds.bodies[0], clouds.ground_radius_km, point, detail, grid_method);
    answer.w = cloud_extinction(point, kWithCurledDetail, grid_method);
    results[item] = answer;
    return;
  }
  if (texture_read == 1 || texture_read == 2) {
    const int n = texture_read == 1 ? textureSize(noise_base, 0).x : textureSize(noise_detail, 0).x;
    const ivec3 texel = ivec3(item % n, item / n % n, item / (n * n));
    results[item] = texture_read == 1 ? texelFetch(noise_base, texel, 0) : texelFetch(noise_detail, texel, 0);
  } else {
    const int n = texture_read == 3 ? textureSize(noise_curl, 0).x : textureSize(weather_map, 0).x;
    const ivec2 texel = ivec2(item % n, item / n);
    results[item] = texture_read == 3 ? texelFetch(noise_curl, texel, 0) : texelFetch(weather_map, texel, 0);
  }
}
