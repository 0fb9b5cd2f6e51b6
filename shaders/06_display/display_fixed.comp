// The display pass with an exposure set by hand: no meter, no buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "06_display/display.glsl"

void main() { show(push.exposure); }
