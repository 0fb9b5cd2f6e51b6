// The air in front of the camera as froxels: boxes of a grid that follows the camera's frustum. Used with terrain only.
#pragma once

#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"
#include "chapters/11_aerial_perspective/relief.hpp"

namespace welkin {

std::vector<Knob> froxel_knobs();  // aerial.method, froxels.*

// Push constants of block.glsl.
struct AerialPush {
  CameraRays camera;
  glm::vec4 position, east, north;
};
AerialPush aerial_push(const app::Context& context, const app::Frame& frame);

// What the passes of this chapter read, and how they name it: the block at binding 0, chapter 09's table at 1 (another
// image stands in when there is none), the shadow map at 2.
class AerialInputs {
 public:
  AerialInputs(const app::Context& context, const AirBlock& air, const MultipleScatteringLut* table,
               const Relief& relief)
      : context_(context), air_(air), table_(table), relief_(relief) {}
  std::vector<gpu::Binding> bindings() const;
  std::vector<graph::Access> accesses() const;
  void write(const gpu::DescriptorSet& set) const;
  gpu::Specialization variant() const;  // constants 0 to 21
  bool colour() const { return context_.settings.choice("froxels.transmittance") == "colour"; }

 private:
  const app::Context context_;
  const AirBlock& air_;
  const MultipleScatteringLut* table_;  // nullptr: orders is 1
  const Relief& relief_;
};

// Pass "aerial perspective": fills the froxels when camera, sun, air or shadows have changed.
class AerialPerspective {
 public:
  AerialPerspective(const app::Context& context, graph::Graph& graph, const AerialInputs& inputs);
  AerialPerspective(const AerialPerspective&) = delete;
  void rebuild();
  const gpu::Image& glow() const { return glow_; }
  const gpu::Image& extinction() const { return inputs_.colour() ? extinction_ : glow_; }
  VkSampler sampler() const { return sampler_; }
  std::vector<graph::Access> reads() const;  // of a pass that looks them up

 private:
  bool make_images();
  uint32_t threads() const;  // that share a direction

  const app::Context context_;
  graph::Graph& graph_;
  const AerialInputs& inputs_;
  gpu::Sampler sampler_;
  gpu::Image glow_, extinction_;
  graph::Resource glow_resource_, extinction_resource_ = 0;
  Watch watch_;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
};

}  // namespace welkin
