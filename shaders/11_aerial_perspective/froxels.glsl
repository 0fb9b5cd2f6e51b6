// The air in front of the camera as a box of texels: x and y are directions, z is the slices behind each other. THREADS
// invocations share a direction. In each round every one of them marches through one slice as if the eye were at its
// near end; then the slices before it are put in front. With one thread that is the plain march outwards, slice by
// slice.
// Included by froxels.comp (PER_CHANNEL 1) and froxels_mean.comp (0: nothing is bound for the channels' extinction).
layout(local_size_x = 64) in;
#include "11_aerial_perspective/block.glsl"

layout(constant_id = 22) const int THREADS = 1;  // that share a direction: 1 ... 64, a power of two
const int RAYS = 64 / THREADS;                   // directions of a workgroup

layout(binding = 3, rgba32f) uniform writeonly image3D froxel_in_scattering;  // w: extinction of the mean
#if PER_CHANNEL
layout(binding = 4, rgba32f) uniform writeonly image3D froxel_extinction;
#endif

shared vec3 shared_depth[2][THREADS][RAYS];  // [round % 2]: of two rounds of slices, one after the other
shared vec3 shared_light[2][THREADS][RAYS];

void store(ivec3 texel, AirSegment segment, float d_km, vec3 sun) {
  const vec3 through = exp(-segment.depth);
  const float mean = -log(max((through.r + through.g + through.b) / 3.0, 1.0e-37));
  // Depth of the mean transmittance. Where 1 - T has too few digits, the mean of the depths is the same.
  const float mean_depth = mean < 1.0e-2 ? (segment.depth.r + segment.depth.g + segment.depth.b) / 3.0 : mean;
  if (!HAS_COLOUR) segment.depth = vec3(mean_depth);
  const Froxel froxel = froxel_of(segment, d_km);
  imageStore(froxel_in_scattering, texel, vec4(froxel.in_scattering * sun, mean_depth / d_km));
#if PER_CHANNEL
  imageStore(froxel_extinction, texel, vec4(froxel.extinction, 0.0));
#endif
}

// [froxels]
void main() {
  const int part = int(gl_LocalInvocationID.x) / RAYS, ray = int(gl_LocalInvocationID.x) % RAYS;
  const ivec2 count = imageSize(froxel_in_scattering).xy;
  const int column = int(gl_WorkGroupID.x) * RAYS + ray;
  const ivec2 texel = ivec2(column % count.x, column / count.x);
  const Atmosphere air = atmosphere;
  const MethodAir method = method_air(air, MS_METHOD);
  // The outer texels lie on the picture's edges, so that every pixel lies between directions of the grid.
  const vec2 place = vec2(texel) / vec2(count - 1) * 2.0 - 1.0;
  const vec3 view = normalize(frame.camera.forward + frame.camera.right * place.x - frame.camera.up * place.y);
  const ClippedRay in_air = clipped_ray(view, frame.camera.altitude_km);
  const ScatteringTowardsEye scattering = scattering_along(air, view, frame.camera.sun);
  AirSegment before = no_air();  // all slices of the rounds before
  // [froxel_rounds]
  for (int round = 0; round * THREADS < SLICES; ++round) {
    const int k = min(round * THREADS + part, SLICES - 1);
    const bool own = round * THREADS + part < SLICES && texel.y < count.y;
    const float t_a = slice_end(float(k), float(SLICES), farthest_km, POWER),
                t_b = slice_end(float(k + 1), float(SLICES), farthest_km, POWER);
    if (THREADS == 1) {
      before = append_segment(method, in_air.air, scattering, before, t_a, t_b, SAMPLES);
      if (own) store(ivec3(texel, k), before, t_b, air.solar_irradiance);
      continue;
    }
    AirSegment slice = no_air();
    if (own) slice = append_segment(method, in_air.air, scattering, slice, t_a, t_b, SAMPLES);
    shared_depth[round % 2][part][ray] = slice.depth;
    barrier();
    vec3 depth = before.depth;
    for (int i = 0; i < part; ++i) depth += shared_depth[round % 2][i][ray];
    shared_light[round % 2][part][ray] = exp(-depth) * slice.radiance;
    barrier();
    AirSegment segment = AirSegment(before.radiance, depth + slice.depth);
    for (int i = 0; i < THREADS; ++i) {
      if (i <= part) segment.radiance += shared_light[round % 2][i][ray];
      before.radiance += shared_light[round % 2][i][ray];
      before.depth += shared_depth[round % 2][i][ray];
    }
    if (own) store(ivec3(texel, k), segment, t_b, air.solar_irradiance);
  }
  // [/froxel_rounds]
}
// [/froxels]
