// From linear radiance to what a screen shows: c = srgb(1 - exp(-exposure L)).
//
// The exponential never clips (the sun and the sky beside it stay apart) and is linear for small L. The sRGB curve is
// IEC 61966-2-1. Exposure is in 1 / radiance.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "common/image/image.hpp"

namespace welkin::image {

// Linear 0..1 to sRGB 0..1; clamps outside, NaN becomes 0.
inline float srgb_encode(float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  linear = std::min(linear, 1.0f);
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

inline glm::vec3 display(const glm::vec3& radiance, float exposure) {
  const auto channel = [&](float value) { return srgb_encode(-std::expm1(-exposure * value)); };
  return {channel(radiance.r), channel(radiance.g), channel(radiance.b)};
}

inline uint8_t quantise(float value) {  // 0..1 to 0..255, to nearest; NaN becomes 0
  return value > 0.0f ? static_cast<uint8_t>(std::min(value, 1.0f) * 255.0f + 0.5f) : uint8_t{0};
}

inline Image8 to_display(const Image& picture, float exposure) {
  Image8 out{picture.width, picture.height, {}};
  out.rgba.reserve(picture.pixels.size() * 4);
  for (const glm::vec4& pixel : picture.pixels) {
    const glm::vec3 shown = display(glm::vec3(pixel), exposure);
    for (int c = 0; c < 3; ++c) out.rgba.push_back(quantise(shown[c]));
    out.rgba.push_back(255);
  }
  return out;
}

}  // namespace welkin::image
