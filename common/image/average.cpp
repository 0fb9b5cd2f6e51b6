// Box filtering. See average.hpp.
#include "common/image/average.hpp"

#include <array>

#include "common/image/display.hpp"

namespace welkin::image {
namespace {

// Calls store(mean) for every pixel of the small picture, in order; at(i) is pixel i of the large one.
template <typename At, typename Store>
void for_means(uint32_t width, uint32_t height, uint32_t n, At&& at, Store&& store) {
  for (size_t y = 0; y < height; y += n)
    for (size_t x = 0; x < width; x += n) {
      glm::dvec4 sum(0.0);
      for (size_t i = 0; i < size_t{n} * n; ++i) sum += at((y + i / n) * width + x + i % n);
      store(sum / (double{1.0} * n * n));
    }
}

}  // namespace

Image averaged(const Image& picture, uint32_t n) {
  Image out{picture.width / n, picture.height / n, {}};
  const auto at = [&](size_t i) { return glm::dvec4(picture.pixels[i]); };
  for_means(picture.width, picture.height, n, at, [&](const glm::dvec4& mean) { out.pixels.emplace_back(mean); });
  return out;
}

Image8 averaged(const Image8& picture, uint32_t n) {
  std::array<double, 256> linear;
  for (size_t v = 0; v < linear.size(); ++v)
    linear[v] = v <= 10 ? v / 255.0 / 12.92 : std::pow((v / 255.0 + 0.055) / 1.055, 2.4);
  Image8 out{picture.width / n, picture.height / n, {}};
  const auto at = [&](size_t i) {
    const uint8_t* p = &picture.rgba[4 * i];
    return glm::dvec4(linear[p[0]], linear[p[1]], linear[p[2]], p[3] / 255.0);
  };
  for_means(picture.width, picture.height, n, at, [&](const glm::dvec4& mean) {
    for (int c = 0; c < 3; ++c) out.rgba.push_back(quantise(srgb_encode(static_cast<float>(mean[c]))));
    out.rgba.push_back(quantise(static_cast<float>(mean.a)));
  });
  return out;
}

}  // namespace welkin::image
