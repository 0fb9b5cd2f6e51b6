// The air in front of the camera as a box of texels: 32 x 32 directions, and behind each other the slices. An invocation is
// one direction; it marches through all slices and keeps what has gathered at the far end of each.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "11_aerial_perspective/block.glsl"

layout(binding = 3, rgba32f) uniform writeonly image3D radiance;       // w: mean transmittance
layout(binding = 4, rgba32f) uniform writeonly image3D transmittance;  // per channel

// [froxels]
void main() {
  const ivec3 texel = ivec3(gl_GlobalInvocationID);
  const ivec2 count = imageSize(radiance).xy;
  if (any(greaterThanEqual(texel.xy, count))) return;
  const Atmosphere air = atmosphere;
  const MethodAir method = method_air(air, MS_METHOD);
  // The outer texels lie on the picture's edges: all of the picture is between directions, nothing is extrapolated.
  const vec2 place = vec2(texel.xy) / vec2(count - 1) * 2.0 - 1.0;
  const vec3 view = normalize(camera.forward.xyz + camera.right.xyz * place.x - camera.up.xyz * place.y);
  const ClippedRay ray = clipped_ray(view, camera.right.w);
  const ScatteringTowardsEye scattering = scattering_along(air, view, camera.sun.xyz);
  RayLight light = no_air();
  float t_a = 0.0;
  for (int k = 0; k < SLICES; ++k) {
    const float t_b = slice_end(float(k + 1), float(SLICES), east.w, POWER);
    light = behind(method, ray.air, scattering, light, t_a, t_b, SAMPLES);
    t_a = t_b;
    const vec3 through = light.transmittance;
    imageStore(radiance, ivec3(texel.xy, k), vec4(light.radiance * air.sun.xyz, (through.r + through.g + through.b) / 3.0));
    if (HAS_COLOUR) imageStore(transmittance, ivec3(texel.xy, k), vec4(through, 0.0));
  }
}
// [/froxels]
