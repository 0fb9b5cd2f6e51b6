// Fills a transmittance table of 32-bit floats.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TABLE_FORMAT rgba32f
#include "08_transmittance_lut/fill_table.glsl"
