// The camera as shaders see it: in the local frame at the camera (x east, y north, z up), so that no large number is
// involved. Shared by C++ and GLSL; 80 bytes: push constants of chapters 03 to 07, and a part of the view block.
#ifndef WELKIN_INTEROP_CAMERA_H
#define WELKIN_INTEROP_CAMERA_H

#ifdef __cplusplus
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
namespace welkin {
using glm::ivec2;
using glm::vec3;
#endif

struct CameraRays {
  vec3 right;         // unit right times tan(fov/2) times aspect
  float altitude_km;  // above the ground
  vec3 up;            // unit up times tan(fov/2)
  float altitude_m;   // the same altitude in m, for cameras close to the ground
  vec3 forward;       // unit look direction
  float time_s;
  vec3 sun;  // unit vector to the sun
  float unused;
  ivec2 size;  // picture, in pixels
  int seed;
  int frame;
};

#ifdef __cplusplus
static_assert(sizeof(CameraRays) == 80 && offsetof(CameraRays, right) == 0 && offsetof(CameraRays, altitude_km) == 12);
static_assert(offsetof(CameraRays, up) == 16 && offsetof(CameraRays, altitude_m) == 28);
static_assert(offsetof(CameraRays, forward) == 32 && offsetof(CameraRays, time_s) == 44);
static_assert(offsetof(CameraRays, sun) == 48 && offsetof(CameraRays, unused) == 60);
static_assert(offsetof(CameraRays, size) == 64 && offsetof(CameraRays, seed) == 72 &&
              offsetof(CameraRays, frame) == 76);
}  // namespace welkin
#endif
#endif
