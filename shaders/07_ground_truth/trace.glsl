// One batch of random paths for every pixel, added to what the batches before left. Rays go through the pixels'
// centres, as in every other chapter: this is the truth of a ray, not of a pixel's area. Included by trace.comp
// (FIRST_SURFACES 0: nothing of them is compiled or bound) and trace_surfaces.comp (1).
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/camera.h"
#include "03_planet_and_rays/camera.glsl"
#include "07_ground_truth/accumulate.glsl"
#include "07_ground_truth/sky_paths.glsl"

layout(binding = 1, std430) readonly buffer Before {
  Accumulated before[];
};
layout(binding = 2, std430) writeonly buffer After {
  Accumulated after[];
};
layout(binding = 3, std430) buffer Cut {
  uint unfinished;  // paths the driver ended before they were done
};
#if FIRST_SURFACES
layout(binding = 4, rgba32f) uniform readonly image2D normals;  // in the eye's local frame; w: distance, km, 0: none
layout(binding = 5, rgba32f) uniform readonly image2D albedos;
#endif
layout(push_constant) uniform Push {
  CameraRays camera;
  ivec4 batch;  // x: first sample, y: samples, z: orders (0: all), w: 1 for the first batch of all
};

// [trace]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size))) return;
  const uint place = uint(pixel.y * camera.size.x + pixel.x);
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(camera, pixel);
  FirstSurface surface = no_surface();
#if FIRST_SURFACES
  const vec4 stored = imageLoad(normals, pixel);
  surface = FirstSurface(stored.w, stored.xyz, imageLoad(albedos, pixel).rgb);
#endif
  vec3 sum = vec3(0.0);
  uint cut = 0u;
  for (int i = 0; i < batch.y; ++i) {
    const Random random = random_stream(place, uint(batch.x + i), uint(camera.seed));
    const PathLight light = trace_path(air, camera.altitude_km, view, camera.sun, surface, batch.z, random);
    sum += light.radiance;
    if (!light.finished) cut += 1u;
  }
  if (cut > 0u) atomicAdd(unfinished, cut);
  Accumulated total = Accumulated(vec4(0.0), vec4(0.0));
  if (batch.w == 0) total = before[place];
  after[place] = accumulated(total, sum / float(batch.y));
}
// [/trace]
