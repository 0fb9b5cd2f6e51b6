// Chapter 03's program: one compute pass that finds for every pixel where its ray meets the planet.
#pragma once

#include <vector>

#include "common/app/chapter.hpp"

namespace welkin {

// rays.form, debug.view, camera.zoom.
std::vector<Knob> planet_knobs();

class PlanetAndRays : public app::Program {
 public:
  explicit PlanetAndRays(const app::Context& context);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;

 private:
  const app::Context context_;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
};

}  // namespace welkin
