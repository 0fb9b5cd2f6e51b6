// Shared by the entry points of chapter 08: chapter 05's march, with the optical depth towards the sun looked up in the
// table.
#ifndef WELKIN_TABLE_SKY_GLSL
#define WELKIN_TABLE_SKY_GLSL

// [variant]
#include "04_air/variant.glsl"
#define TRANSMITTANCE_BINDING 1
#include "08_transmittance_lut/table.glsl"
layout(constant_id = 6) const bool SUN_DISC = true;
layout(constant_id = 7) const int RULE = 5;
#define SUN_OPTICAL_DEPTH optical_depth_to_top
#include "05_single_scattering/single_scattering.glsl"
#include "05_single_scattering/sun_disc.glsl"
// [/variant]

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
const int UNUSED_LIGHT_STEPS = 1;  // nothing marches towards the sun

#endif
