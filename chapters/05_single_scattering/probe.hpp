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
// Rays that miss the air start at its top and look up: radiance 0, transmittance 1.
struct MarchRay {
  glm::vec4 view;  // xyz: direction in the local frame (z up), w: altitude in km
  glm::vec4 sun;   // xyz: direction to the sun, same frame
};
MarchRay march_ray(const app::ProbeRay& ray, const Planet& planet);

// On the board before the effects of a probe: a buffer of MarchRays, and one of results, two vec4 per ray: radiance and
// transmittance.
struct ProbeBuffers {
  struct Range {
    int32_t count = 0;
  };
  graph::Resource rays, results;
  std::shared_ptr<Range> range;  // how many rays are in the buffers now
};

// Adds the pass "probe": the step, which writes the results, and the barrier after which the host may read them.
void add_probe_pass(app::Builder& builder, graph::Resource results, graph::Step step);

// A graph of effects that computes the light along rays. The last effect adds its pass with add_probe_pass().
class ProbeRun {
 public:
  // most: the largest number of rays that run() will get. More than 65,536 go in batches.
  ProbeRun(const app::Context& context, std::vector<app::Effect> effects, size_t most);
  // of_first_ray: the camera stands where the first ray begins, for tables made for one place; all rays must begin
  // there.
  std::vector<app::ProbeResult> run(std::span<const app::ProbeRay> rays, bool of_first_ray = false);

 private:
  const app::Context context_;
  size_t room_;
  std::unique_ptr<app::Composition> composition_;
};

}  // namespace welkin
