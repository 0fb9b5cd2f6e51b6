// Pictures in memory. Row 0 is on top; pixels run left to right, then down: index = y * width + x.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

namespace welkin {

constexpr uint32_t kMaxImageSide = 16384;  // accepted by every reader and writer here, each side

// Linear radiance, RGBA, unbounded above. Alpha is carried along and takes part in no measurement.
struct Image {
  uint32_t width = 0, height = 0;
  std::vector<glm::vec4> pixels;  // width * height
};

// Display values 0..255, sRGB-encoded, RGBA.
struct Image8 {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;  // width * height * 4
};

// Sixteen bits a sample, one channel: a height map.
struct Image16 {
  uint32_t width = 0, height = 0;
  std::vector<uint16_t> gray;  // width * height
};

}  // namespace welkin
