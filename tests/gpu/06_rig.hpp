// A display without a chapter around it: pictures are put in, frames are drawn, and everything is read back.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "chapters/06_display/display.hpp"
#include "common/app/renderer.hpp"
#include "common/graph/composition.hpp"
#include "tests/gpu/harness.hpp"

namespace welkin::test {

struct Item {
  float in[8];  // which function of tests/gpu/shaders/06_display.comp, then its arguments
};
struct Answer {
  float out[4];
};
std::vector<Answer> evaluate_items(const std::vector<Item>& items);

class DisplayRig {
 public:
  DisplayRig(VkExtent2D size, const std::vector<std::pair<std::string, std::string>>& knobs, const Post& post = {});

  void set_picture(const Image& picture);
  void draw(uint32_t index, double seconds);

  std::vector<uint32_t> histogram() const;
  ExposureState state() const;
  Image8 displayed() const;
  std::vector<gpu::PassTime> times() { return timer_.read(); }
  // Follows the settings, and says whether there is a meter.
  bool metered();
  Settings& settings() { return settings_; }
  Post& post() { return scene_.post; }
  // Bytes the display allocated beside the two pictures.
  uint64_t bytes() const { return bytes_; }

 private:
  template <typename T>
  std::vector<T> read(const gpu::Buffer& buffer) const;

  Scene scene_;
  Settings settings_;
  std::string inject_;
  app::Context context_;
  gpu::CommandPool pool_;
  VkCommandBuffer commands_;
  gpu::Timer timer_;
  uint64_t bytes_ = 0;
  gpu::Buffer given_;  // the picture that is put in
  gpu::Image picture_, displayed_;
  std::unique_ptr<app::Composition> display_;
};

// A picture of one colour, or of what `at` says for each pixel.
Image flat_picture(uint32_t width, uint32_t height, glm::vec3 color);

// The same hash and the same bin as the shader's, from the integer definition.
double pixel_noise_reference(uint32_t x, uint32_t y, uint32_t seed);

// Mean of log2 luminance between two ranks, in double, from the pixels themselves and no histogram. nullopt: all black.
std::optional<double> trimmed_mean_log2(const Image& picture, double low, double high);

}  // namespace welkin::test
