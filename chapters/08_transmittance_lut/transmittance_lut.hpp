// The air's constants and the transmittance table as passes of a frame graph, for this chapter and those after it.
//
// A pass that looks transmittance up
//   1. names air.resource() (gpu::kUniformRead) and table.resource() (gpu::kSampledRead) among its accesses,
//   2. binds air.buffer() as uniform block and (image(), sampler()) as combined image sampler,
//   3. begins its specialization constants with table.variant(), and in its shader includes 04_air/variant.glsl,
//   defines
//      TRANSMITTANCE_BINDING, includes 08_transmittance_lut/table.glsl; constants of its own begin at 6,
//   4. on rebuild() is called after the table, and writes the table into its descriptor set again: the image may be
//   another.
#pragma once

#include <optional>
#include <vector>

#include "chapters/04_air/air.hpp"
#include "common/graph/graph.hpp"

namespace welkin {

// transmittance.width, .height, .steps, .mapping, .stored, .format.
std::vector<Knob> transmittance_knobs();

// Pass "air": writes the uniform block of the atmosphere, when it differs from what is there.
// --inject wrong-constant: Rayleigh scattering of red 10 % too strong.
class AirBlock {
 public:
  AirBlock(const app::Context& context, graph::Graph& graph);
  AirBlock(const AirBlock&) = delete;
  const gpu::Buffer& buffer() const { return buffer_; }
  graph::Resource resource() const { return resource_; }

 private:
  interop::Atmosphere wanted() const;

  const app::Context context_;
  gpu::Buffer buffer_;
  graph::Resource resource_;
  std::optional<interop::Atmosphere> written_;
};

// Pass "transmittance": fills the table, when the air has changed. The constructor makes everything; on rebuild() the
// table follows the knobs, and nothing happens when neither they nor the shader are other than before.
class TransmittanceLut {
 public:
  TransmittanceLut(const app::Context& context, graph::Graph& graph, const AirBlock& air);
  TransmittanceLut(const TransmittanceLut&) = delete;
  void rebuild();  // as Program::rebuild
  const gpu::Image& image() const { return image_; }
  VkSampler sampler() const { return sampler_; }
  graph::Resource resource() const { return resource_; }
  // Constants 0 to 5 of a shader that reads the table: the air's variant, mapping, stored.
  gpu::Specialization variant() const;

 private:
  const app::Context context_;
  graph::Graph& graph_;
  const AirBlock& air_;
  gpu::Sampler sampler_;
  gpu::Image image_;
  graph::Resource resource_;
  std::vector<uint32_t> built_;  // what the pipeline was made from
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
};

// Executes a graph once outside of any frame, and waits: for --probe and tests. Its passes may use only frame.commands,
// frame.timer and frame.index.
void execute_once(const gpu::Device& device, graph::Graph& graph);

}  // namespace welkin
