// What the entry points of chapter 05 share: the effects compiled in, the atmosphere, and one ray's light.
#ifndef WELKIN_SKY_GLSL
#define WELKIN_SKY_GLSL

// [variant]
// Known when the pipeline is made, so that the compiler drops the code of what the scene lacks.
#include "04_air/variant.glsl"  // constants 0 to 3: which constituents there are, and the aerosol's phase function
layout(constant_id = 4) const bool SUN_DISC = true;
layout(constant_id = 5) const int RULE = 5;
layout(constant_id = 6) const int LIGHT_STEPS = 8;  // of the innermost loop: known, so that it can be unrolled
// [/variant]

#include "05_single_scattering/single_scattering.glsl"
#include "05_single_scattering/sun_disc.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};

#endif
