// The sky view table as a pass of a frame graph: the whole sky and ground seen from the camera's altitude, for this
// chapter and those after it.
//
// A pass that looks it up
//   1. names resource() (gpu::kSampledRead) among its accesses and binds (image(), sampler()),
//   2. in its shader defines SKY_VIEW_BINDING and the constant SKY_VIEW_UNIT (its bits: unit()), and includes
//      10_sky_view_lut/sky_view.glsl,
//   3. asks serves() of the frame's altitude first: where it is false the table is not kept, and the direct march of
//      chapter 09 takes its place,
//   4. on rebuild() is called after the table, and writes the table into its descriptor set again: the image may be
//   another.
#pragma once

#include <optional>
#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {

// sky_view.method, .size, .steps, .format, .highest.
std::vector<Knob> sky_view_knobs();

// Pass "sky view": both marches of chapter 09 per texel, when the air, the camera's altitude or the sun's height has
// changed; with one order, chapter 05's alone.
class SkyViewLut {
 public:
  // scattering: nullptr where `orders` is 1; the table then holds single scattering.
  SkyViewLut(const app::Context& context, graph::Graph& graph, const AirBlock& air,
             const MultipleScatteringLut* scattering);
  SkyViewLut(const SkyViewLut&) = delete;
  void rebuild();  // as Program::rebuild, after the scattering table
  const gpu::Image& image() const { return image_; }
  VkSampler sampler() const { return sampler_; }
  graph::Resource resource() const { return resource_; }
  uint32_t unit() const;  // the bits of SKY_VIEW_UNIT
  // Whether the sky seen from this altitude comes from the table, by the knobs sky_view.method and .highest.
  bool serves(double altitude_km) const;

 private:
  struct Seen {  // what the table depends on beside the air
    float altitude_km, mu_sun;
    int view_steps, table_steps;
    bool operator==(const Seen&) const = default;
  };
  Seen seen(const app::Frame& frame) const;
  bool half() const { return image_.format == VK_FORMAT_R16G16B16A16_SFLOAT; }

  const app::Context context_;
  graph::Graph& graph_;
  const AirBlock& air_;
  const MultipleScatteringLut* scattering_;
  gpu::Sampler sampler_;
  gpu::Image image_;
  graph::Resource resource_;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
  std::optional<Seen> filled_;
};

}  // namespace welkin
