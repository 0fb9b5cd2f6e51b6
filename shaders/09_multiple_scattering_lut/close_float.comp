// Writes the final table as rgba32f.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(binding = 4, rgba32f) uniform writeonly image2D final_table;
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }
#include "09_multiple_scattering_lut/close.glsl"
