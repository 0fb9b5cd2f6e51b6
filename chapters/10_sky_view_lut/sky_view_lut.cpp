// The pass "sky view". See sky_view_lut.hpp and docs/chapters/10_sky_view_lut.md.
#include "chapters/10_sky_view_lut/sky_view_lut.hpp"

#include <bit>
#include <cmath>

namespace welkin {
namespace {

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr float kHalfUnit = 1.0f / 4096.0f;  // as in sky_view_half.comp

struct FillPush {
  glm::vec4 place;
  int32_t view_steps, table_steps, unused[2];
};

gpu::Image make_table(const app::Context& context) {
  const std::string& size = context.settings.choice("sky_view.size");
  const size_t cross = size.find('x');
  return gpu::create_image(
      context.device, "sky view",
      {static_cast<uint32_t>(std::stoi(size)), static_cast<uint32_t>(std::stoi(size.substr(cross + 1)))},
      context.settings.choice("sky_view.format") == "half" ? VK_FORMAT_R16G16B16A16_SFLOAT
                                                           : VK_FORMAT_R32G32B32A32_SFLOAT,
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

}  // namespace

// [knobs]
std::vector<Knob> sky_view_knobs() {
  return {{.name = "sky_view.method",
           .meaning = "where the sky comes from: the table, the direct march, or whichever is right for the altitude",
           .initial = 0,
           .choices = {"auto", "table", "march"},
           .ladder = {1, 2}},
          {.name = "sky_view.size",
           .unit = "texels",
           .meaning = "azimuths x heights in the table",
           .initial = 1,
           .choices = {"96x54", "192x108", "288x162", "384x216", "768x432"},
           .ladder = {0, 1, 2, 3},
           .rebuilds = true},
          {.name = "sky_view.steps",
           .unit = "steps",
           .meaning = "samples of the first order along a texel's ray, in fours",
           .minimum = 4,
           .maximum = 512,
           .initial = 16,
           .integer = true,
           .ladder = {8, 16, 32}},
          {.name = "sky_view.format",
           .meaning = "bits of a number in the table: 16 or 32",
           .initial = 1,
           .choices = {"half", "float"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "sky_view.highest",
           .unit = "km",
           .meaning = "altitude above which `auto` marches",
           .minimum = 0,
           .maximum = 1000,
           .initial = 20}};
}
// [/knobs]

// [pass]
SkyViewLut::SkyViewLut(const app::Context& context, graph::Graph& graph, const AirBlock& air,
                       const MultipleScatteringLut* scattering)
    : context_(context),
      graph_(graph),
      air_(air),
      scattering_(scattering),
      sampler_(gpu::create_sampler(context.device)),
      image_(make_table(context)),
      resource_(graph.add("sky view", image_)) {
  std::vector<graph::Access> accesses{{air.resource(), gpu::kUniformRead}, {resource_, gpu::kComputeWrite}};
  if (scattering != nullptr) accesses.push_back({scattering->resource(), gpu::kSampledRead});
  graph.add({.name = "sky view",
             .accesses = std::move(accesses),
             .record =
                 [this](const app::Frame& frame) {
                   filled_ = seen(frame);
                   const float sun_sine = std::hypot(frame.camera.sun.x, frame.camera.sun.y);
                   const FillPush push{{filled_->altitude_km, filled_->mu_sun, sun_sine, 0.0f},
                                       filled_->view_steps,
                                       filled_->table_steps,
                                       {}};
                   gpu::dispatch(frame.commands, pipeline_, set_, push, (image_.size.width + 31) / 32,
                                 image_.size.height);
                 },
             .changed = [this](const app::Frame& frame) { return filled_ != seen(frame); },
             .idle = [this](const app::Frame& frame) { return !serves(frame.camera.altitude_km); }});
  rebuild();
}

// The sun's azimuth is no part of it: the table is turned towards the sun when it is read.
SkyViewLut::Seen SkyViewLut::seen(const app::Frame& frame) const {
  const CameraRays& camera = frame.camera;
  return {camera.altitude_km, camera.sun.z, context_.settings.integer("sky_view.steps"),
          scattering_ != nullptr ? context_.settings.integer("multiple_scattering.view_steps") : 0};
}
// [/pass]

bool SkyViewLut::serves(double altitude_km) const {
  const std::string& method = context_.settings.choice("sky_view.method");
  return method == "table" || (method == "auto" && altitude_km <= context_.settings.number("sky_view.highest"));
}

uint32_t SkyViewLut::unit() const { return std::bit_cast<uint32_t>(half() ? kHalfUnit : 1.0f); }

void SkyViewLut::rebuild() {
  image_ = {};
  image_ = make_table(context_);
  graph_.replace(resource_, image_);
  std::vector<gpu::Binding> bindings{{0, kUniform}, {2, kImage}};
  if (scattering_ != nullptr) bindings.push_back({1, kTable});
  const std::string shader = fmt::format("10_sky_view_lut/sky_view{}_{}.comp", scattering_ != nullptr ? "" : "_single",
                                         half() ? "half" : "float");
  pipeline_ = gpu::create_compute_pipeline(
      context_.device, shader, std::move(bindings), sizeof(FillPush),
      scattering_ != nullptr ? scattering_->variant() : specialization(air_variant(context_.scene)));
  set_ = gpu::create_descriptor_set(context_.device, pipeline_.set_layout, pipeline_.bindings);
  gpu::write_buffer(context_.device, set_, 0, kUniform, air_.buffer());
  gpu::write_storage_image(context_.device, set_, 2, image_);
  if (scattering_ != nullptr)
    gpu::write_sampled_image(context_.device, set_, 1, scattering_->image(), scattering_->sampler());
}

}  // namespace welkin
