// The sky from the table, and the sun's disc behind the air.
#version 460
#extension GL_GOOGLE_include_directive : require
#define SUN_DISC
#include "10_sky_view_lut/sky_picture.glsl"
