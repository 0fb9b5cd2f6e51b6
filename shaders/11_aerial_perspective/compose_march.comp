// The picture, with the air marched for every pixel: what the froxels are measured against.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FROXELS 0
#include "11_aerial_perspective/compose.glsl"
