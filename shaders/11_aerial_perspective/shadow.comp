// For every place of the map, in km: the altitude from which the sun's centre is seen past the terrain, the altitude
// over which its radius rises (half the penumbra), and the height of the ground. Walks over the height map towards the
// sun, to the map's end.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "11_aerial_perspective/height_maps.glsl"

layout(binding = 2, rgba32f) uniform writeonly image2D shadow_map;
layout(push_constant) uniform Push {
  vec4 sun;  // xyz: unit vector in the global frame; w: angular radius, rad
};

// [shadow]
void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(shadow_map);
  if (any(greaterThanEqual(texel, size))) return;
  const HeightField field = height_field();
  const vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  const vec2 place = vec2(uv.x - 0.5, 0.5 - uv.y) * EXTENT_KM;
  const vec3 up = up_at(GROUND_RADIUS_KM, place);
  const float mu = dot(sun.xyz, up);
  const vec3 level = sun.xyz - up * mu;
  const float sine = length(level);
  const vec2 towards = sine > 1.0e-4 ? level.xy / sine : vec2(0.0);
  // Terrain nearer than a texel of either map is left out: there the slope itself says how the sun lights the ground.
  const float start_km = 0.75 * EXTENT_KM / float(min(MAP_SIZE, size.x));
  int visits = 0;
  const vec2 over = shadow_over(field, place, towards, mu / max(sine, 1.0e-4), start_km, visits);
  const vec2 grid = grid_at(field, place);
  const ivec2 cell = ivec2(grid);
  const float ground = patch_along(patch_corners(cell), grid - vec2(cell), vec2(0.0)).x;
  imageStore(shadow_map, texel, vec4(over.x, max(over.y * sun.w, 1.0e-3), ground, 0.0));
}
// [/shadow]
