// The clouds of a scene with what their light needs, bound: for every entry point of chapter 18. Bindings 0 to 5 are chapter
// 17's, 6 the bounds of its grids. An entry point's own begin at 7.
#ifndef WELKIN_CLOUD_SCENE_BLOCK_GLSL
#define WELKIN_CLOUD_SCENE_BLOCK_GLSL

// Of the air's constituents chapter 07's sampling knows; clouds have none of them.
const bool HAS_RAYLEIGH = false;
const bool HAS_MIE = false;
const bool HAS_OZONE = false;
const int MIE_PHASE = 0;
const bool CLOUD_ENVIRONMENT = false;

#define CLOUD_BINDING 0
#include "17_cloud_shapes/block.glsl"

layout(binding = 6) uniform sampler3D cloud_bounds;
float grid_bound(int i, int j, int k) { return texelFetch(cloud_bounds, ivec3(i, j, k), 0).r; }

#include "18_cloud_light/cloud_march.glsl"

#endif
