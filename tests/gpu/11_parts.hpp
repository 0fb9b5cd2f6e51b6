// What chapter 11's tests share: functions of its shaders over arrays, scenes drawn without a window, and height maps
// as files.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "chapters/11_aerial_perspective/lit_terrain.hpp"
#include "common/app/camera.hpp"
#include "common/app/renderer.hpp"
#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

namespace welkin::test {

enum class AirPart { march, first_slice, all_orders, to_the_end, planet, hit, scalars, surface, ground, sign, shadow };

// a, b, c as tests/gpu/shaders/11_parts.comp reads them; c[3] is set from `part`.
struct AirItem {
  AirPart part;
  std::array<double, 4> a{}, b{}, c{};
};
struct AirAnswer {
  std::array<double, 3> radiance, transmittance;
};
// method: 0 published, 2 moments; without `orders` single scattering.
std::vector<AirAnswer> evaluate_air(const reference::Planet& planet, const std::vector<AirItem>& items,
                                    bool orders = false, uint32_t method = 0);

// Single scattering (Henyey-Greenstein, g 0.8) of the first d km of a ray, in double: that of the whole ray less that
// of its rest, seen through the first part.
Light truth_to(const reference::Planet& planet, const SkyRay& ray, double d_km);

// Those that draw chapter 11's picture, without meter and display.
std::vector<app::Effect> terrain_effects();

// A scene drawn by a chapter's program, linear.
class Drawn {
 public:
  Drawn(const Scene& scene, VkExtent2D size, const std::vector<std::pair<std::string, std::string>>& knobs,
        bool chapter_10 = false);
  Image picture(const View& view, uint32_t index = 0);
  std::vector<std::string> passes() const { return passes_; }
  std::string explain() const { return program_->explain(); }
  uint64_t bytes() const { return bytes_; }

 private:
  Scene scene_;
  Settings settings_;
  std::string inject_;
  app::Context context_;
  app::Chapter chapter_;
  uint64_t bytes_ = 0;
  std::unique_ptr<app::Program> program_;
  std::unique_ptr<app::Renderer> renderer_;
  std::vector<std::string> passes_;
};

Scene scene_named(const std::string& name);

void write_gray(const std::filesystem::path& file, uint32_t width, uint32_t height,
                const std::vector<uint16_t>& samples, int bits);

// Writes a grayscale PNG of 8 or 16 bits; `at` gives 0 ... 65535 for column and row.
template <typename At>
void write_height_map(const std::filesystem::path& file, uint32_t width, uint32_t height, const At& at, int bits = 16) {
  std::vector<uint16_t> samples;
  for (uint32_t j = 0; j < height; ++j)
    for (uint32_t i = 0; i < width; ++i) samples.push_back(static_cast<uint16_t>(at(i, j)));
  write_gray(file, width, height, samples, bits);
}

}  // namespace welkin::test
