// What the entry points of chapter 08 share: chapter 05's march with the air towards the sun looked up.
#ifndef WELKIN_TABLE_SKY_GLSL
#define WELKIN_TABLE_SKY_GLSL

// [variant]
#include "04_air/variant.glsl"
#define TRANSMITTANCE_BINDING 1
#include "08_transmittance_lut/table.glsl"
layout(constant_id = 6) const bool SUN_DISC = true;
layout(constant_id = 7) const int RULE = 5;
#define SUN_OPTICAL_DEPTH clear_optical_depth
#include "05_single_scattering/single_scattering.glsl"
#include "05_single_scattering/sun_disc.glsl"
// [/variant]

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
const int NO_LIGHT_STEPS = 1;

#endif
