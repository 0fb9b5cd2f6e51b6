// Light of all clouds along the rays of --probe: paths, the march, or order 1 converged. A ray's work is spread over blocks.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define CLOUD_BINDING 0
#include "18_cloud_light/scene_block.glsl"
#include "18_cloud_light/cloud_path.glsl"
#include "18_cloud_light/first_order.glsl"
#include "18_cloud_light/march_push.glsl"

struct Ray {
  vec4 origin;     // w: altitude
  vec4 rest;       // w: cosine to the vertical
  vec4 direction;  // w: sine
  vec4 end;        // x: distance to the ground, found in double
  vec4 sun;        // w: ground albedo
};
layout(binding = 7, std430) readonly buffer Rays {
  Ray rays[];
};
layout(binding = 8, std430) writeonly buffer Results {
  vec4 results[];  // sum of radiance, of its squares, paths not finished
};
layout(push_constant) uniform Push {
  CloudLightPush march;
  ivec4 work;   // method, blocks a ray, samples a block, invocations
  ivec4 extra;  // orders, first block, seed
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(work.w)) return;
  const Ray from = rays[i / uint(work.y)];
  const int block = extra.y + int(i % uint(work.y));
  CloudRay ray = CloudRay(from.origin.xyz, from.rest.xyz, from.direction.xyz, from.origin.w, from.rest.w, from.direction.w, 0.0, from.end.x);
  ray = below_ceiling(clouds.ground_radius_km, clouds.ceiling_km, ray);
  vec4 result = vec4(0.0);
  if (work.x == 0) {
    const CloudPathSettings settings = CloudPathSettings(extra.x, march.columns.y, 0.5, from.sun.w, from.sun.xyz);
    for (int k = 0; k < work.z; ++k) {
      const Random random = random_stream(i / uint(work.y), uint(block * work.z + k), uint(extra.z));
      const CloudPathLight light = trace_cloud_path(settings, ray, random);
      result += vec4(light.radiance, light.radiance * light.radiance, 0.0, light.finished ? 1.0 : 0.0);
    }
    result.z = float(work.z) - result.w;
  } else if (work.x == 1) {
    CloudMarchSettings settings = march_settings(march);
    settings.sun = from.sun.xyz;
    result.x = march_cloud_light(ray, settings).radiance;
  } else {
    const CloudMarch fine = CloudMarch(max(march.columns.x, 128), march.columns.y, kGridExact, 1, 0.5);
    result.x = first_order_of_clouds(ray, from.sun.xyz, fine, RayPart(block, work.y));
  }
  results[i] = result;
}
