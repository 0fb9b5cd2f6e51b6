// Fills the sky view table with single scattering, in 32-bit floats.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(binding = 2, rgba32f) uniform writeonly image2D sky_view;
const float SKY_VIEW_UNIT = 1.0;
#define SINGLE_ORDER
#include "10_sky_view_lut/fill_sky_view.glsl"
