// Chapter 11's program: chapter 10's sky, and before it terrain seen through air. A scene without terrain is chapter
// 10's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/app/chapter.hpp"

namespace welkin {

std::vector<Knob> aerial_sky_knobs();  // of this chapter and of all it uses

class AerialSky : public app::Program {
 public:
  explicit AerialSky(const app::Context& context);
  ~AerialSky() override;
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;
  std::string explain() const override;
  const gpu::Image* image(const std::string& name) const override;

 private:
  struct Frames;  // the graph and what is in it; made anew when a pass comes or goes
  void make_compose();

  const app::Context context_;
  std::unique_ptr<Frames> frames_;
  const gpu::Image* target_ = nullptr;
};

}  // namespace welkin
