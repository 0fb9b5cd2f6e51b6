// Draws the sky from the table, and the sun's disc seen through the air.
#version 460
#extension GL_GOOGLE_include_directive : require
#define SUN_DISC
#include "10_sky_view_lut/sky_picture.glsl"
