// The clouds of a scene with what their light needs, bound: for every entry point of chapter 18. The entry point defines
// CLOUD_BINDING: six bindings from there are chapter 17's, the next one is the bounds of its grids. One that knows the air has
// its variant before this and defines CLOUD_WITH_AIR.
#ifndef WELKIN_CLOUD_SCENE_BLOCK_GLSL
#define WELKIN_CLOUD_SCENE_BLOCK_GLSL

#ifndef CLOUD_WITH_AIR
// Of the air's constituents chapter 07's sampling knows; clouds have none of them.
const bool HAS_RAYLEIGH = false;
const bool HAS_MIE = false;
const bool HAS_OZONE = false;
const int MIE_PHASE = 0;
#endif
const bool CLOUD_ENVIRONMENT = false;

#include "17_cloud_shapes/block.glsl"

layout(binding = CLOUD_BINDING + 6) uniform sampler3D cloud_bounds;
float grid_bound(int i, int j, int k) { return texelFetch(cloud_bounds, ivec3(i, j, k), 0).r; }

#include "18_cloud_light/cloud_march.glsl"

#endif
