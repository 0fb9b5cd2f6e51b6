// What every pass of a frame graph may know of the frame: the block "View". Included by C++ and by GLSL.
//
// km; the global frame (origin on the ground at the scene's place, x east, y north, z up there) where nothing else is
// said; the cameras' vectors are in their own local frames (interop/camera.h). std140.
#ifndef WELKIN_INTEROP_VIEW_H
#define WELKIN_INTEROP_VIEW_H

#include "camera.h"

#ifdef __cplusplus
namespace welkin {
#endif

// [view]
struct ViewBlock {
  CameraRays camera;       // of this frame
  CameraRays last_camera;  // of the frame before; this frame's where `cut` is 1
  vec3 position_km;        // of the camera, rounded to float32,
  float delta_s;           // since the frame before
  vec3 position_rest_km;   // and what the rounding left out
  int cut;                 // 1: nothing of the frames before may be used
  vec3 last_position_km;
  float jitter_x;  // of the rays, in pixels; 0 until a chapter jitters them
  vec3 last_position_rest_km;
  float jitter_y;
  vec3 east;  // the camera's local frame in the global one; up is their cross product
  float unused_east;
  vec3 north;
  float unused_north;
};
// [/view]

#ifdef __cplusplus
static_assert(sizeof(ViewBlock) == 256 && offsetof(ViewBlock, last_camera) == 80);
static_assert(offsetof(ViewBlock, position_km) == 160 && offsetof(ViewBlock, delta_s) == 172);
static_assert(offsetof(ViewBlock, position_rest_km) == 176 && offsetof(ViewBlock, cut) == 188);
static_assert(offsetof(ViewBlock, last_position_km) == 192 && offsetof(ViewBlock, jitter_x) == 204);
static_assert(offsetof(ViewBlock, last_position_rest_km) == 208 && offsetof(ViewBlock, jitter_y) == 220);
static_assert(offsetof(ViewBlock, east) == 224 && offsetof(ViewBlock, unused_east) == 236);
static_assert(offsetof(ViewBlock, north) == 240 && offsetof(ViewBlock, unused_north) == 252);
}  // namespace welkin
#endif
#endif
