// Box filtering. See average.hpp.
#include "common/image/average.hpp"

#include <array>

#include "common/image/display.hpp"

namespace welkin::image {
namespace {

float srgb_decode(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

// Calls store(mean) for every pixel of the small picture, in order; at(i) is pixel i of the large one.
template <typename At, typename Store>
void for_means(uint32_t width, uint32_t height, uint32_t n, At&& at, Store&& store) {
  for (size_t y = 0; y < height; y += n)
    for (size_t x = 0; x < width; x += n) {
      glm::dvec4 sum(0.0);
      for (size_t i = 0; i < size_t{n} * n; ++i) sum += at((y + i / n) * width + x + i % n);
      store(glm::vec4(sum / (double{1.0} * n * n)));
    }
}

}  // namespace

Image averaged(const Image& picture, uint32_t n) {
  if (n == 1) return picture;
  Image out{picture.width / n, picture.height / n, {}};
  for_means(
      picture.width, picture.height, n, [&](size_t i) { return glm::dvec4(picture.pixels[i]); },
      [&](const glm::vec4& mean) { out.pixels.push_back(mean); });
  return out;
}

Image8 averaged(const Image8& picture, uint32_t n) {
  if (n == 1) return picture;
  std::array<double, 256> linear;
  for (size_t v = 0; v < linear.size(); ++v) linear[v] = srgb_decode(static_cast<float>(v) / 255.0f);
  Image8 out{picture.width / n, picture.height / n, {}};
  const auto at = [&](size_t i) {
    const uint8_t* p = &picture.rgba[4 * i];
    return glm::dvec4(linear[p[0]], linear[p[1]], linear[p[2]], p[3] / 255.0);
  };
  for_means(picture.width, picture.height, n, at, [&](const glm::vec4& mean) {
    for (int c = 0; c < 3; ++c) out.rgba.push_back(quantise(srgb_encode(mean[c])));
    out.rgba.push_back(quantise(mean.a));
  });
  return out;
}

}  // namespace welkin::image
