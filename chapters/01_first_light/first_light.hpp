// Chapter 01's program: one compute shader that writes one image.
#pragma once

#include "common/app/chapter.hpp"

namespace welkin {

class FirstLight : public app::Program {
 public:
  explicit FirstLight(const app::Context& context);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;

 private:
  const app::Context context_;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
};

}  // namespace welkin
