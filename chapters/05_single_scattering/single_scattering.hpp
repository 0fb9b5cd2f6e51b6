// Chapter 05's program: the ray march for pictures and for single rays.
#pragma once

#include <vector>

#include "chapters/04_air/air.hpp"
#include "common/app/chapter.hpp"

namespace welkin {

inline constexpr uint32_t kRuleAdapted = 5;  // of the choices of the knob `rule`: the one later chapters march by

// The chapter's knobs: view.steps, light.steps, rule.
std::vector<Knob> march_knobs();

// A probe's ray as the shader takes it. For cameras above the air the first point is where the ray enters it, found in
// double: seen from 36 000 km, rounding the direction to float32 alone moves the tangent point and puts the limb's
// transmittance off by 0.1 %.
// Rays that miss the air start at its top, looking up: they see nothing, through nothing.
struct MarchRay {
  glm::vec4 view;  // xyz: direction in the local frame (z up), w: altitude in km
  glm::vec4 sun;   // xyz: direction to the sun, same frame
};
MarchRay march_ray(const app::ProbeRay& ray, const Planet& planet);

class SingleScattering : public app::Program {
 public:
  explicit SingleScattering(const app::Context& context);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;

 private:
  gpu::Specialization variant() const;
  void update_air(VkCommandBuffer commands) const;

  const app::Context context_;
  gpu::Buffer air_;  // the uniform block of the atmosphere
  gpu::ComputePipeline image_;
  gpu::DescriptorSet image_set_;
};

}  // namespace welkin
