// The view block, for every entry point whose pass stands in a frame graph: frame.camera, frame.position_km, …
#ifndef WELKIN_VIEW_BLOCK_GLSL
#define WELKIN_VIEW_BLOCK_GLSL

#include "interop/view.h"

layout(binding = 15, std140) uniform View {
  ViewBlock frame;
};

#endif
