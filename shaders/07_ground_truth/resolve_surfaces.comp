// Turns sums into a picture, behind images of first surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#define FIRST_SURFACES 1
#include "07_ground_truth/resolve.glsl"
