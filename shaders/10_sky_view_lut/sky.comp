// The sky from the table, without the sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "10_sky_view_lut/sky_picture.glsl"
