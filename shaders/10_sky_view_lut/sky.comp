// Draws the sky from the table, without the sun's disc.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "10_sky_view_lut/sky_picture.glsl"
