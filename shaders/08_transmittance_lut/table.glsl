// Included by every entry point that reads the transmittance table. The entry point includes 04_air/variant.glsl first
// and defines where the table is bound: #define TRANSMITTANCE_BINDING n. Takes specialization constants 4 and 5.
#ifndef WELKIN_TRANSMITTANCE_TABLE_GLSL
#define WELKIN_TRANSMITTANCE_TABLE_GLSL

layout(constant_id = 4) const int TABLE_MAPPING = 1;  // knob transmittance.mapping
layout(constant_id = 5) const int TABLE_STORED = 1;   // knob transmittance.stored

layout(binding = TRANSMITTANCE_BINDING) uniform sampler2D transmittance_table;

vec3 read_transmittance_table(vec2 uv) { return textureLod(transmittance_table, uv, 0.0).rgb; }
ivec2 transmittance_table_size() { return textureSize(transmittance_table, 0); }

#include "08_transmittance_lut/transmittance_lut.glsl"

#endif
