// The camera as shaders see it: in the local frame at the camera (x east, y north, z up), so that no large number is
// involved. Shared by C++ and GLSL; 80 bytes of push constants.
#ifndef WELKIN_INTEROP_CAMERA_H
#define WELKIN_INTEROP_CAMERA_H

#ifdef __cplusplus
#include <glm/vec4.hpp>
#include <cstddef>
namespace welkin {
using glm::ivec4;
using glm::vec4;
#endif

struct CameraRays {
  vec4 right;    // xyz: unit right times tan(fov/2) times aspect; w: altitude in km above the ground
  vec4 up;       // xyz: unit up times tan(fov/2); w: the same altitude in m, for cameras close to the ground
  vec4 forward;  // xyz: unit look direction; w: time in s
  vec4 sun;      // xyz: unit vector to the sun; w: unused
  ivec4 size;    // xy: picture in pixels; z: seed; w: frame index
};

#ifdef __cplusplus
static_assert(sizeof(CameraRays) == 80 && offsetof(CameraRays, sun) == 48 && offsetof(CameraRays, size) == 64);
}  // namespace welkin
#endif
#endif
