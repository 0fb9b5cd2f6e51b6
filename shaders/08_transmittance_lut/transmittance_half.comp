// Fills a transmittance table of 16-bit floats.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TABLE_FORMAT rgba16f
#include "08_transmittance_lut/fill_table.glsl"
