// Filling the froxels. See aerial_perspective.hpp and docs/chapters/11_aerial_perspective.md.
#include "chapters/11_aerial_perspective/aerial_perspective.hpp"

#include <bit>
#include <glm/trigonometric.hpp>

namespace welkin {
namespace {

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr uint32_t kWorkgroup = 64;    // as in froxels.comp
constexpr size_t kFirstConstant = 16;  // of this chapter; those before belong to chapters 04 and 09

}  // namespace

// [knobs]
std::vector<Knob> froxel_knobs() {
  return {
      {.name = "aerial.method",
       .meaning = "where the air before terrain comes from: froxels, or a march per pixel",
       .initial = 0,
       .choices = {"froxels", "march"},
       .rebuilds = true},
      {.name = "aerial.march_slices",
       .unit = "slices",
       .meaning = "of the march per pixel",
       .minimum = 4,
       .maximum = 512,
       .initial = 64,
       .integer = true,
       .rebuilds = true},
      {.name = "froxels.size",
       .unit = "texels",
       .meaning = "directions across the picture, and down",
       .minimum = 4,
       .maximum = 128,
       .initial = 32,
       .integer = true,
       .ladder = {16, 32, 64},
       .rebuilds = true},
      {.name = "froxels.slices",
       .unit = "slices",
       .meaning = "behind each other",
       .minimum = 4,
       .maximum = 256,
       .initial = 32,
       .integer = true,
       .ladder = {16, 32, 64},
       .rebuilds = true},
      {.name = "froxels.samples",
       .unit = "samples",
       .meaning = "in a slice: 1, or pairs of Gauss nodes",
       .minimum = 1,
       .maximum = 8,
       .initial = 2,
       .integer = true,
       .rebuilds = true},
      {.name = "froxels.power",
       .meaning = "the far end of slice s of n lies at (s/n)^power of the distance",
       .minimum = 1,
       .maximum = 4,
       .initial = 2,
       .rebuilds = true},
      {.name = "froxels.distance_km",
       .unit = "km",
       .meaning = "where the last slice ends; the march serves what lies beyond",
       .minimum = 1,
       .maximum = 1000,
       .initial = 128},
      {.name = "froxels.threads",
       .unit = "threads",
       .meaning = "that share a direction, a slice each; auto: 32, but on a processor, where only their sum counts, 1",
       .initial = 0,
       .choices = {"auto", "1", "8", "32"},
       .rebuilds = true},
      {.name = "froxels.transmittance",
       .meaning = "kept as the mean of the channels, or per channel in an image of its own",
       .initial = 1,
       .choices = {"mean", "colour"},
       .rebuilds = true}};
}
// [/knobs]

AerialPush aerial_push(const app::Context& context, const app::Frame& frame) {
  const Standpoint at = standpoint(frame, context.scene.planet.ground_radius_km);
  const Terrain& terrain = *context.scene.terrain;
  const double signs = terrain.signs_azimuth_deg ? glm::radians(*terrain.signs_azimuth_deg) : -1e3;
  return {frame.camera,
          {at.position_km, terrain.extent_km},
          {at.east, context.settings.number("froxels.distance_km")},
          {at.north, signs}};
}

std::vector<gpu::Binding> AerialInputs::bindings() const { return {{0, kUniform}, {1, kSampled}, {2, kSampled}}; }

std::vector<graph::Access> AerialInputs::accesses() const {
  std::vector<graph::Access> accesses{{air_.resource(), gpu::kUniformRead}};
  if (table_ != nullptr) accesses.push_back({table_->resource(), gpu::kSampledRead});
  if (relief_.has_shadows()) accesses.push_back({relief_.shadow_resource(), gpu::kSampledRead});
  return accesses;
}

void AerialInputs::write(const gpu::DescriptorSet& set) const {
  gpu::write_buffer(context_.device, set, 0, kUniform, air_.buffer());
  if (table_ != nullptr)
    gpu::write_sampled_image(context_.device, set, 1, table_->image(), table_->sampler());
  else
    gpu::write_sampled_image(context_.device, set, 1, relief_.cover(),
                             relief_.sampler());  // unread: HIGHER_ORDERS is false
  gpu::write_sampled_image(context_.device, set, 2, relief_.has_shadows() ? relief_.shadows() : relief_.cover(),
                           relief_.sampler());
}

// [variant]
gpu::Specialization AerialInputs::variant() const {
  const Settings& settings = context_.settings;
  gpu::Specialization constants = table_ != nullptr ? table_->variant() : specialization(air_variant(context_.scene));
  if (table_ == nullptr) constants.insert(constants.end(), {0u, 0u, 1u});  // no method, no map, no size
  constants.resize(kFirstConstant);
  const int samples = settings.integer("froxels.samples");
  constants.insert(constants.end(), {table_ != nullptr, relief_.has_shadows(), colour(),
                                     static_cast<uint32_t>(settings.integer("froxels.slices")),
                                     static_cast<uint32_t>(samples == 1 ? 1 : (samples + 1) / 2 * 2),
                                     std::bit_cast<uint32_t>(static_cast<float>(settings.number("froxels.power")))});
  return constants;
}
// [/variant]

// [passes]
AerialPerspective::AerialPerspective(const app::Context& context, graph::Graph& graph, const AerialInputs& inputs)
    : context_(context),
      graph_(graph),
      inputs_(inputs),
      sampler_(gpu::create_sampler(context.device)),
      glow_resource_(graph.add("froxels", glow_)) {
  make_images();
  std::vector<graph::Access> accesses = inputs.accesses();
  accesses.push_back({glow_resource_, gpu::kComputeWrite});
  if (inputs.colour()) {
    extinction_resource_ = graph.add("froxel extinction", extinction_);
    accesses.push_back({extinction_resource_, gpu::kComputeWrite});
  }
  graph.add({.name = "aerial perspective",
             .accesses = std::move(accesses),
             .record =
                 [this](const app::Frame& frame) {
                   watch_.note(frame);
                   const uint32_t rays = kWorkgroup / threads();  // of a workgroup
                   gpu::dispatch(frame.commands, pipeline_, set_, aerial_push(context_, frame),
                                 (glow_.size.width * glow_.size.height + rays - 1) / rays);
                 },
             .changed = [this](const app::Frame& frame) { return watch_.differs(frame); },
             .idle =
                 [this](const app::Frame& frame) {
                   return frame.camera.altitude_km >=
                          context_.scene.planet.top_radius_km - context_.scene.planet.ground_radius_km;
                 }});
  rebuild();
}

std::vector<graph::Access> AerialPerspective::reads() const {
  std::vector<graph::Access> accesses{{glow_resource_, gpu::kSampledRead}};
  if (inputs_.colour()) accesses.push_back({extinction_resource_, gpu::kSampledRead});
  return accesses;
}
// [/passes]

// 32 bits: at dusk radiance is 1e-6 of noon's, where a half has two or three digits left of its three. True if made
// anew.
bool AerialPerspective::make_images() {
  const uint32_t side = static_cast<uint32_t>(context_.settings.integer("froxels.size")),
                 slices = static_cast<uint32_t>(context_.settings.integer("froxels.slices"));
  if (glow_.size.width == side && glow_.depth == slices) return false;
  const auto make = [&](const char* name) {
    return gpu::create_image(context_.device, name, {side, side}, VK_FORMAT_R32G32B32A32_SFLOAT,
                             VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, slices);
  };
  glow_ = make("froxels");
  if (inputs_.colour()) extinction_ = make("froxel extinction");
  return true;
}

uint32_t AerialPerspective::threads() const {
  const std::string& wanted = context_.settings.choice("froxels.threads");
  if (wanted != "auto") return static_cast<uint32_t>(std::stoi(wanted));
  return context_.device.candidate().software ? 1 : 32;
}

void AerialPerspective::rebuild() {
  if (make_images()) {
    graph_.replace(glow_resource_, glow_);
    if (inputs_.colour()) graph_.replace(extinction_resource_, extinction_);
  }
  std::vector<gpu::Binding> bindings = inputs_.bindings();
  bindings.insert(bindings.end(), {{3, kImage}, {4, kImage}});
  gpu::Specialization constants = inputs_.variant();
  constants.push_back(threads());
  pipeline_ = gpu::create_compute_pipeline(context_.device, "11_aerial_perspective/froxels.comp", bindings,
                                           sizeof(AerialPush), constants);
  if (set_.handle == VK_NULL_HANDLE)
    set_ = gpu::create_descriptor_set(context_.device, pipeline_.set_layout, pipeline_.bindings);
  inputs_.write(set_);
  gpu::write_storage_image(context_.device, set_, 3, glow_);
  gpu::write_storage_image(context_.device, set_, 4, extinction());
  graph_.redo(glow_resource_);
}

}  // namespace welkin
