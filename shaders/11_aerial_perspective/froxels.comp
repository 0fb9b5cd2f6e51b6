// The froxels, with an extinction per channel.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PER_CHANNEL 1
#include "11_aerial_perspective/froxels.glsl"
