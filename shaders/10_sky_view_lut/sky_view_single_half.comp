// Fills the sky view table with single scattering, in 16-bit floats. Their smallest number is 6e-8: a night's radiance
// is stored magnified.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(binding = 2, rgba16f) uniform writeonly image2D sky_view;
const float SKY_VIEW_UNIT = (1.0 / 4096.0);
#define SINGLE_ORDER
#include "10_sky_view_lut/fill_sky_view.glsl"
