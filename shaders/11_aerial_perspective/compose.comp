// The picture, with the air from the froxels.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROXELS 1
#include "11_aerial_perspective/compose.glsl"
