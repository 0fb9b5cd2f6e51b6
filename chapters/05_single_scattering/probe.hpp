// Single rays through a graph: what --probe asks of this chapter and all that follow. Rays go to the device in batches.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/graph/composition.hpp"

namespace welkin {

// A probe's ray as the shader takes it. For cameras above the air the first point is where the ray enters it, found in
// double: seen from 36 000 km, rounding the direction to float32 alone moves the tangent point and puts the limb's
// transmittance off by 0.1 %.
// Rays that miss the air start at its top, looking up: they see nothing, through nothing.
struct MarchRay {
  glm::vec4 view;  // xyz: direction in the local frame (z up), w: altitude in km
  glm::vec4 sun;   // xyz: direction to the sun, same frame
};
MarchRay march_ray(const app::ProbeRay& ray, const Planet& planet);

// On the board, before the effects of a probe: MarchRay after MarchRay, and for each two vec4, radiance and
// transmittance.
struct ProbeBuffers {
  struct Range {
    int32_t count = 0;
  };
  graph::Resource rays, results;
  std::shared_ptr<Range> range;  // that is in the buffers now
};

// Adds the pass "probe": the step, which writes probe.results, and their way back to the host.
void add_probe_pass(app::Builder& builder, const ProbeBuffers& probe, graph::Step step);

// A graph of effects that answers rays: the last adds its pass with add_probe_pass().
class ProbeRun {
 public:
  // most: rays there will be at once; more than 65,536 go in batches.
  ProbeRun(const app::Context& context, std::vector<app::Effect> effects, size_t most);
  // of_first_ray: the camera stands where the first ray begins, for tables of a place; all rays share it.
  std::vector<app::ProbeResult> run(std::span<const app::ProbeRay> rays, bool of_first_ray = false);

 private:
  const app::Context context_;
  size_t room_;
  std::unique_ptr<app::Composition> composition_;
};

}  // namespace welkin
