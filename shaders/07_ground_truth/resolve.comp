// Turns sums into a picture, over the smooth planet.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FIRST_SURFACES 0
#include "07_ground_truth/resolve.glsl"
