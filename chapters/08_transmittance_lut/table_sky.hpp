// Chapter 08's program: chapter 05's march, with the air on the way to the sun from the transmittance table.
#pragma once

#include <string>
#include <vector>

#include "chapters/08_transmittance_lut/transmittance_lut.hpp"

namespace welkin {

// view.steps and rule of chapter 05, and transmittance.*.
std::vector<Knob> table_sky_knobs();

class TableSky : public app::Program {
 public:
  explicit TableSky(const app::Context& context);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;
  std::string explain() const override { return graph_.explain(); }
  const gpu::Image* image(const std::string& name) const override {
    return name == "transmittance" ? &table_.image() : nullptr;
  }
  const graph::Graph& graph() const { return graph_; }

 private:
  gpu::Specialization variant() const;
  void make_pipeline();

  const app::Context context_;
  graph::Graph graph_;
  AirBlock air_;
  TransmittanceLut table_;
  graph::Resource picture_ = 0;
  const gpu::Image* target_ = nullptr;
  gpu::ComputePipeline image_;
  gpu::DescriptorSet image_set_;
};

}  // namespace welkin
