// The height map and the tree of its maxima as images, for the walks of height_field.glsl. Bindings 0 and 1, constants
// 0 to 4.
#ifndef WELKIN_HEIGHT_MAPS_GLSL
#define WELKIN_HEIGHT_MAPS_GLSL

layout(constant_id = 0) const float GROUND_RADIUS_KM = 6360.0;
layout(constant_id = 1) const float EXTENT_KM = 128.0;
layout(constant_id = 2) const float HIGHEST_KM = 3.0;
layout(constant_id = 3) const int MAP_SIZE = 1024;   // samples a side
layout(constant_id = 4) const int TREE_LEVELS = 7;   // of the tree of maxima

layout(binding = 0) uniform sampler2D height_map;
layout(binding = 1) uniform sampler2D height_maxima;  // levels 1, 2, ... below each other; made by height_maxima()

// [height_maps]
vec4 patch_corners(ivec2 cell) {
  const ivec2 low = clamp(cell - 1, 0, MAP_SIZE - 1), high = clamp(cell, 0, MAP_SIZE - 1);
  return vec4(texelFetch(height_map, low, 0).r, texelFetch(height_map, ivec2(high.x, low.y), 0).r,
              texelFetch(height_map, ivec2(low.x, high.y), 0).r, texelFetch(height_map, high, 0).r);
}

float highest_in(ivec2 node, int level) {
  const int side = 2 * textureSize(height_maxima, 0).x;  // of level 0, in patches
  return texelFetch(height_maxima, node + ivec2(0, side - (side >> (level - 1))), 0).r;
}
// [/height_maps]

#include "11_aerial_perspective/height_field.glsl"

HeightField height_field() { return HeightField(GROUND_RADIUS_KM, EXTENT_KM, HIGHEST_KM, MAP_SIZE, TREE_LEVELS); }

#endif
