// The froxels, with one extinction for all channels.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PER_CHANNEL 0
#include "11_aerial_perspective/froxels.glsl"
