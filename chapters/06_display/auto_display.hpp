// From the linear picture to 8 bits: a light meter, a tone curve, the screen's curve, dithering. Chapters from here on
// show their pictures through it.
//
// Three passes: "histogram" counts log2 luminance, "exposure" turns the counts into one number and follows it in time,
// "display" draws. With an exposure set by hand the first two do not exist, nor do their buffers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/app/chapter.hpp"

namespace welkin {

// exposure.* of the meter and display.* of the curve.
std::vector<Knob> display_knobs();

// What the meter found, as it lies in its buffer.
struct ExposureState {
  float exposure;     // log2 of the factor light is multiplied by, before compensation
  float target;       // where it is going
  float mean_log2;    // of the luminance between the two ranks
  uint32_t measured;  // samples that had a logarithm
};

// Share of the way to a target that is gone after `seconds`: 1 - exp(-seconds / tau), without cancellation; 1 if tau is
// 0.
double adapted_share(double seconds, double tau_s);

class AutoDisplay : public app::DisplaySystem {
 public:
  explicit AutoDisplay(const app::Context& context);
  void set_images(const gpu::Image& picture, const gpu::Image& displayed) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::string explain() const override;

  // For tests and tables; none when the exposure is set by hand. Last written by compute.
  const gpu::Buffer* histogram() const { return meter_ ? &meter_->histogram : nullptr; }
  const gpu::Buffer* state() const { return meter_ ? &meter_->state : nullptr; }

 private:
  struct Meter {
    gpu::Buffer histogram, state;
    gpu::ComputePipeline count, expose;
    gpu::DescriptorSet count_set, expose_set;
    bool fresh = true;  // nothing measured yet
  };
  void make_meter();
  void measure(const app::Frame& frame);
  void bind();

  const app::Context context_;
  std::optional<Meter> meter_;
  gpu::ComputePipeline display_;
  gpu::DescriptorSet display_set_;
  const gpu::Image* picture_ = nullptr;
  const gpu::Image* displayed_ = nullptr;
};

std::unique_ptr<app::DisplaySystem> make_display(const app::Context& context);

}  // namespace welkin
