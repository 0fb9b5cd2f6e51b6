// From sums to a picture: the mean, the sun's disc behind the air, and the standard error per workgroup.
// Included by resolve.comp (FIRST_SURFACES 0) and resolve_surfaces.comp (1: surfaces hide the disc).
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/camera.h"
#include "03_planet_and_rays/camera.glsl"
#include "07_ground_truth/accumulate.glsl"
#include "07_ground_truth/sky_paths.glsl"
#include "05_single_scattering/sun_disc.glsl"

layout(binding = 1, std430) readonly buffer Sums {
  Accumulated sums[];
};
layout(binding = 2, rgba32f) uniform writeonly image2D target;
layout(binding = 3, std430) writeonly buffer Groups {
  vec4 groups[];  // x: standard errors, y: luminances, z: batches, w: which accumulation
};
#if FIRST_SURFACES
layout(binding = 4, rgba32f) uniform readonly image2D normals;  // w: distance, km, 0: no surface
#endif
layout(push_constant) uniform Push {
  CameraRays camera;
  ivec4 batches;  // x: how many, y: which accumulation
};

shared vec2 group[64];

// [resolve]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  const bool inside = all(lessThan(pixel, camera.size));  // no thread leaves early: all meet at the barriers
  vec2 mine = vec2(0.0);
  if (inside) {
    const Accumulated total = sums[pixel.y * camera.size.x + pixel.x];
    const float n = float(batches.x);
    vec3 radiance = mean_radiance(total, n);
    mine = vec2(standard_error(total, n), luminance_of(radiance));
#if FIRST_SURFACES
    const bool free = imageLoad(normals, pixel).w <= 0.0;
#else
    const bool free = true;
#endif
    if (SUN_DISC && free) radiance += sun_disc_light(atmosphere, camera, pixel, camera_direction(camera, pixel));
    imageStore(target, pixel, vec4(radiance, 1.0));
  }
  group[gl_LocalInvocationIndex] = mine;
  for (uint half_size = 32u; half_size > 0u; half_size /= 2u) {
    barrier();
    if (gl_LocalInvocationIndex < half_size)
      group[gl_LocalInvocationIndex] += group[gl_LocalInvocationIndex + half_size];
  }
  if (gl_LocalInvocationIndex == 0u)
    groups[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] =
        vec4(group[0], float(batches.x), float(batches.y));
}
// [/resolve]
