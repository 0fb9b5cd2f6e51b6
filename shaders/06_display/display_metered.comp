// The display pass with the exposure of the meter, which stays on the device.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "06_display/display.glsl"
layout(binding = 2, std430) readonly buffer State { float exposure; } state;

void main() { show(state.exposure + push.exposure); }
