// Chapter 04's program: a sky of constant density, drawn on a sky sphere by a small graphics pipeline.
#pragma once

#include "chapters/04_air/air.hpp"
#include "chapters/04_air/sky_sphere.hpp"
#include "common/app/chapter.hpp"

namespace welkin {

class ConstantSkyProgram : public app::Program {
 public:
  explicit ConstantSkyProgram(const app::Context& context);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;

 private:
  void make_sphere_pipeline(const gpu::Specialization& constants);
  void draw_sphere(const app::Frame& frame);

  const app::Context context_;
  bool per_vertex_ = false;
  uint32_t index_count_ = 0;
  gpu::Buffer atmosphere_;  // interop::Atmosphere, written by each frame
  gpu::Buffer directions_;  // vec4 per vertex
  gpu::Buffer colours_;     // vec4 per vertex; only with sky.method = per_vertex
  gpu::Buffer indices_;
  gpu::Image sky_;  // what the sphere is drawn into; the target is a storage image and no attachment
  gpu::ComputePipeline colour_pipeline_, finish_pipeline_;
  gpu::DescriptorSet colour_set_, sphere_set_, finish_set_;
  gpu::SetLayout sphere_set_layout_;
  gpu::PipelineLayout sphere_layout_;
  gpu::PipelineHandle sphere_pipeline_;
  const gpu::Image* target_ = nullptr;
};

}  // namespace welkin
