// The table of light scattered before, as a pass of a frame graph, for this chapter and those after it.
//
// A pass that looks it up
//   1. names air.resource() (gpu::kUniformRead) and table.resource() (gpu::kSampledRead) among its accesses,
//   2. binds air.buffer() as uniform block and (image(), sampler()) as combined image sampler,
//   3. begins its specialization constants with table.variant(); in its shader declares the sampler, defines
//      read_multiple_scattering_table(uv) by it, and includes 09_multiple_scattering_lut/variant.glsl, which declares
//      the block at binding 0 (or declares constants 0 to 6 itself and includes multiple_scattering.glsl); its own
//      begin at 7,
//   4. on rebuild() is called after the table, and writes the table into its descriptor set again: the image may be
//   another.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "chapters/08_transmittance_lut/transmittance_lut.hpp"

namespace welkin {

// orders, and multiple_scattering.method, .iterations, .directions, .set, .steps, .view_steps, .size, .map, .format.
std::vector<Knob> multiple_scattering_knobs();

// Whether these settings want the table: `orders` is not 1. Without it there is no pass and no image: do not make one.
bool wants_multiple_scattering(const Settings& settings);

// Orders to gather before the series of this air can be closed: 3 + 2 tau + 0.3 tau^2, tau its scattering optical depth
// straight up in the channel where it is deepest; 64 at most.
int orders_of(const interop::Atmosphere& air);

// Pass "multiple scattering": fills the table, when the air has changed.
class MultipleScatteringLut {
 public:
  MultipleScatteringLut(const app::Context& context, graph::Graph& graph, const AirBlock& air);
  MultipleScatteringLut(const MultipleScatteringLut&) = delete;
  void rebuild();  // as Program::rebuild
  const gpu::Image& image() const { return table_; }
  VkSampler sampler() const { return sampler_; }
  graph::Resource resource() const { return resource_; }
  std::string explain() const;  // how many orders it gathers, and why
  // Constants 0 to 6 of a shader that reads the table: the air's variant, method, map, size.
  gpu::Specialization variant() const;

 private:
  // Images of the orders while they are gathered: the first, and three that take turns.
  static constexpr size_t kFirst = 0;
  size_t place_of(int orders) const { return orders == 1 ? kFirst : 1 + static_cast<size_t>(orders - 2) % 3; }
  bool published() const { return context_.settings.choice("multiple_scattering.method") == "published"; }
  int orders_gathered() const;
  int directions() const { return (context_.settings.integer("multiple_scattering.directions") + 15) / 16 * 16; }
  int steps() const { return (context_.settings.integer("multiple_scattering.steps") + 3) / 4 * 4; }
  uint32_t rays() const;  // that differ, for a sun anywhere: altitudes times zenith angles
  void make_images();
  void record(const app::Frame& frame) const;

  const app::Context context_;
  graph::Graph& graph_;
  const AirBlock& air_;
  gpu::Sampler sampler_;
  gpu::Image table_;
  std::array<gpu::Image, 4> orders_;
  graph::Resource resource_;
  gpu::Buffer nodes_;  // of the rays light is gathered along
  gpu::ComputePipeline place_, first_, next_, close_;
  gpu::DescriptorSet place_set_, first_set_, close_set_;
  std::array<gpu::DescriptorSet, 4> next_sets_;  // by the image that is read
};

}  // namespace welkin
