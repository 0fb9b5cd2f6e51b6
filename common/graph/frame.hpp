// What a pass gets for one frame.
#pragma once

#include <glm/vec3.hpp>

#include "common/gpu/timer.hpp"
#include "shaders/interop/camera.h"

namespace welkin::app {

struct Frame {
  VkCommandBuffer commands;
  const gpu::Image& target;  // rgba32f storage image; draw() writes all of it and leaves it in layout GENERAL
  const CameraRays& camera;
  gpu::Timer& timer;
  uint32_t index;
  uint32_t seed;
  double seconds;               // since the frame before; 0 for the first
  glm::dvec3 position_km{0.0};  // of the camera, in the global frame of camera.hpp
  bool cut = false;             // what was seen before has nothing to do with this frame: another scene, a jump
};

}  // namespace welkin::app
