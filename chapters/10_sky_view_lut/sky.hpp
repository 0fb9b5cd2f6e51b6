// Chapter 10's program: the sky looked up in the sky view table, or marched where the table is not good enough.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "chapters/10_sky_view_lut/sky_view_lut.hpp"

namespace welkin {

// Those of chapters 05, 08, 09 that it uses, without their ladders, and the chapter's own; and `tables`, which has
// every table computed in every frame.
std::vector<Knob> sky_knobs();

// Pass "sky": writes a picture of the sky, from the table or by the direct march; the sun's disc behind the air.
class SkyPass {
 public:
  SkyPass(const app::Context& context, graph::Graph& graph);
  SkyPass(const SkyPass&) = delete;
  void rebuild();
  // The picture, an rgba32f storage image; before the first frame, and whenever it is another.
  void set_target(const gpu::Image& target, gpu::Use outside = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT});
  graph::Resource resource() const { return *picture_; }
  const gpu::Image* image(const std::string& name) const;  // its tables, as Program::image

  const AirBlock& air() const { return air_; }
  const TransmittanceLut* transmittance() const { return transmittance_.get(); }
  const MultipleScatteringLut* scattering() const { return scattering_.get(); }
  const SkyViewLut& sky_view() const { return sky_view_; }

 private:
  void write_targets();

  const app::Context context_;
  graph::Graph& graph_;
  AirBlock air_;
  std::unique_ptr<TransmittanceLut> transmittance_;    // none without the sun's disc
  std::unique_ptr<MultipleScatteringLut> scattering_;  // none with orders = 1
  SkyViewLut sky_view_;
  std::optional<graph::Resource> picture_;
  const gpu::Image* target_ = nullptr;
  gpu::ComputePipeline look_, march_;
  gpu::DescriptorSet look_set_, march_set_;
};

class SkyProgram : public app::Program {
 public:
  explicit SkyProgram(const app::Context& context);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;
  std::string explain() const override;
  const gpu::Image* image(const std::string& name) const override;

 private:
  const app::Context context_;
  std::unique_ptr<graph::Graph> graph_;
  std::unique_ptr<SkyPass> sky_;
  const gpu::Image* target_ = nullptr;
  bool disc_ = false, all_orders_ = false;  // what the passes were made for
};

}  // namespace welkin
