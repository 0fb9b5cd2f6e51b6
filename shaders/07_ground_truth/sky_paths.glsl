// What the entry points of chapter 07 share: what is compiled in, and the atmosphere.
#ifndef WELKIN_SKY_PATHS_GLSL
#define WELKIN_SKY_PATHS_GLSL

// [variant]
#include "04_air/variant.glsl"  // constants 0 to 3
layout(constant_id = 4) const bool SUN_DISC = true;
layout(constant_id = 5) const int TRACKING = 3;
layout(constant_id = 6) const bool HERO = true;
const bool ENVIRONMENT = false;
const bool SPREAD = true;
#ifdef FIRST_SURFACES
const bool SURFACES = FIRST_SURFACES == 1;
#else
const bool SURFACES = false;
#endif
// [/variant]

#include "07_ground_truth/path.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};

#endif
