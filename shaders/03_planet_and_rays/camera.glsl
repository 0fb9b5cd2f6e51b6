// From a pixel to a ray. Directions are unit vectors in the local frame at the camera: x east, y north, z up.
#ifndef WELKIN_CAMERA_GLSL
#define WELKIN_CAMERA_GLSL

#include "interop/camera.h"

// [camera]
// Unit direction through the centre of a pixel; pixel (0, 0) is top left. The pixel's place (2 p + 1 - size) / size in
// -1 … 1 is one division of whole numbers: its rounding error is 6e-8 of half a picture, however narrow the field of
// view. What limits a narrow view is the direction, whose components are accurate to 6e-8 (see the page's hard cases).
vec3 camera_direction(CameraRays camera, ivec2 pixel) {
  float x = float(2 * pixel.x + 1 - camera.size.x) / float(camera.size.x);
  float y = float(2 * pixel.y + 1 - camera.size.y) / float(camera.size.y);
  vec3 direction = camera.forward + (camera.right * x - camera.up * y);
  return direction / length(direction);
}
// [/camera]

#endif
