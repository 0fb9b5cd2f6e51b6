// Chapter 09's program: chapter 05's march, and all further orders of scattering from a table.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {

// view.steps of chapter 05, those of the table, and `tables`.
std::vector<Knob> all_orders_knobs();

class AllOrdersSky : public app::Program {
 public:
  explicit AllOrdersSky(const app::Context& context);
  ~AllOrdersSky() override;
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;
  std::string explain() const override;
  const gpu::Image* image(const std::string& name) const override;

 private:
  struct Frames;  // the graph and what is in it; made anew when the table comes or goes
  gpu::ComputePipeline make_pipeline(const Frames& frames, bool probe) const;

  const app::Context context_;
  std::unique_ptr<Frames> frames_;
  const gpu::Image* target_ = nullptr;
};

}  // namespace welkin
