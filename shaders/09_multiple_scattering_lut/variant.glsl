// Shared by the entry points of chapter 09: specialization constants, the atmosphere's block and the pure functions.
// The entry point defines read_multiple_scattering_table() before it includes this file.
#ifndef WELKIN_MULTIPLE_SCATTERING_VARIANT_GLSL
#define WELKIN_MULTIPLE_SCATTERING_VARIANT_GLSL

#include "04_air/variant.glsl"  // constants 0 to 3
layout(constant_id = 4) const int MS_METHOD = 2;
layout(constant_id = 5) const int MS_MAP = 1;
layout(constant_id = 6) const int MS_SIZE = 32;

#include "09_multiple_scattering_lut/multiple_scattering.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};

#endif
