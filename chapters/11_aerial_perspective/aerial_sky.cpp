// The graph of chapter 11's frame, and the pass that puts it together. See aerial_sky.hpp.
#include "chapters/11_aerial_perspective/aerial_sky.hpp"

#include <algorithm>
#include <optional>

#include "chapters/10_sky_view_lut/sky.hpp"
#include "chapters/11_aerial_perspective/aerial_perspective.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

}  // namespace

// [knobs]
std::vector<Knob> aerial_sky_knobs() {
  std::vector<Knob> all = froxel_knobs();
  for (Knob& knob : terrain_knobs()) all.push_back(std::move(knob));
  for (Knob& knob : sky_knobs()) {
    knob.ladder.clear();  // chapter 10's page has its curve
    all.push_back(std::move(knob));
  }
  return all;
}
// [/knobs]

// [frames]
// With terrain the sky is drawn into an image of its own, and the picture is composed; without, the sky is the picture.
struct AerialSky::Frames {
  explicit Frames(const app::Context& context)
      : graph(context.inject),
        all_orders(wants_multiple_scattering(context.settings)),
        colour(context.settings.choice("froxels.transmittance") == "colour"),
        disc(context.scene.sun.disc),
        sky(context, graph) {
    if (!context.scene.terrain) return;
    relief.emplace(context, graph);
    inputs.emplace(context, sky.air(), sky.scattering(), *relief);
    if (context.settings.choice("aerial.method") == "froxels") aerial.emplace(context, graph, *inputs);
  }
  bool fits(const app::Context& context) const {
    return all_orders == wants_multiple_scattering(context.settings) &&
           colour == (context.settings.choice("froxels.transmittance") == "colour") && disc == context.scene.sun.disc &&
           relief.has_value() == context.scene.terrain.has_value() &&
           (!relief || aerial.has_value() == (context.settings.choice("aerial.method") == "froxels"));
  }

  graph::Graph graph;
  bool all_orders, colour, disc;  // what the passes were made for
  SkyPass sky;
  std::optional<Relief> relief;
  std::optional<AerialInputs> inputs;
  std::optional<AerialPerspective> aerial;
  gpu::Image sky_image;
  graph::Resource picture = 0;
  bool compiled = false;
  gpu::ComputePipeline compose;
  gpu::DescriptorSet set;
};
// [/frames]

AerialSky::AerialSky(const app::Context& context) : context_(context) { rebuild(); }
AerialSky::~AerialSky() = default;

void AerialSky::rebuild() {
  if (!frames_ || !frames_->fits(context_)) {
    frames_.reset();
    frames_ = std::make_unique<Frames>(context_);
  } else {
    frames_->sky.rebuild();
    if (frames_->relief) frames_->relief->rebuild();
    if (frames_->aerial) frames_->aerial->rebuild();
  }
  if (frames_->relief) make_compose();
  if (target_ != nullptr) set_target(*target_);
}

// [compose]
void AerialSky::make_compose() {
  const gpu::Device& device = context_.device;
  Frames& frames = *frames_;
  const Relief& relief = *frames.relief;
  gpu::Specialization constants = frames.inputs->variant();
  constants.insert(constants.end(), {static_cast<uint32_t>(context_.settings.integer("aerial.march_slices")),
                                     context_.settings.choice("terrain.edges") == "on"});
  std::vector<gpu::Binding> bindings = frames.inputs->bindings();
  if (frames.aerial) bindings.insert(bindings.end(), {{3, kSampled}, {4, kSampled}});
  bindings.insert(bindings.end(), {{5, kImage}, {6, kSampled}, {7, kSampled}, {8, kImage}, {9, kImage}});
  frames.compose = gpu::create_compute_pipeline(
      device, frames.aerial ? "11_aerial_perspective/compose.comp" : "11_aerial_perspective/compose_march.comp",
      bindings, sizeof(AerialPush), constants);
  frames.set = gpu::create_descriptor_set(device, frames.compose.set_layout, frames.compose.bindings);
  frames.inputs->write(frames.set);
  if (frames.aerial) {
    gpu::write_sampled_image(device, frames.set, 3, frames.aerial->glow(), frames.aerial->sampler());
    gpu::write_sampled_image(device, frames.set, 4, frames.aerial->extinction(), frames.aerial->sampler());
  }
  gpu::write_sampled_image(device, frames.set, 6, relief.slopes(), relief.sampler());
  gpu::write_sampled_image(device, frames.set, 7, relief.cover(), relief.sampler());
}

void AerialSky::set_target(const gpu::Image& target) {
  target_ = &target;
  Frames& frames = *frames_;
  constexpr gpu::Use displayed{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};  // between frames; what it held is not needed
  if (!frames.relief) {
    frames.sky.set_target(target);
    if (!frames.compiled) frames.graph.want(frames.sky.resource());
  } else {
    frames.sky_image = gpu::create_image(context_.device, "sky", target.size, VK_FORMAT_R32G32B32A32_SFLOAT,
                                         VK_IMAGE_USAGE_STORAGE_BIT);
    frames.sky.set_target(frames.sky_image, {});
    frames.relief->set_size(target.size);
    gpu::write_storage_image(context_.device, frames.set, 5, frames.relief->distance());
    gpu::write_storage_image(context_.device, frames.set, 8, frames.sky_image);
    gpu::write_storage_image(context_.device, frames.set, 9, target);
    if (frames.compiled)
      frames.graph.replace(frames.picture, target);
    else
      frames.picture = frames.graph.add("picture", target, displayed);
  }
  if (frames.compiled) return;
  if (frames.relief) {
    std::vector<graph::Access> accesses = frames.inputs->accesses();
    if (frames.aerial)
      for (const graph::Access& access : frames.aerial->reads()) accesses.push_back(access);
    accesses.push_back({frames.relief->distance_resource(), gpu::kComputeRead});
    accesses.push_back({frames.sky.resource(), gpu::kComputeRead});
    accesses.push_back({frames.picture, gpu::kComputeWrite});
    frames.graph.add({.name = "compose",
                      .accesses = std::move(accesses),
                      .record =
                          [this](const app::Frame& frame) {
                            gpu::dispatch_over(frame.commands, frames_->compose, frames_->set,
                                               aerial_push(context_, frame), frame.target.size);
                          },
                      .changed = [](const app::Frame&) { return true; }});
    frames.graph.want(frames.picture);
  }
  frames.graph.compile();
  frames.compiled = true;
}
// [/compose]

void AerialSky::draw(const app::Frame& frame) {
  if (context_.settings.choice("tables") == "all") frames_->graph.redo();
  if (!frames_->relief) return frames_->graph.execute(frame);
  const Lifted from = lifted(frame, frames_->relief->map(), context_.scene.planet.ground_radius_km);
  frames_->graph.execute({frame.commands, frame.target, from.camera, frame.timer, frame.index, frame.seed,
                          frame.seconds, from.position_km});
}

// A probe's ray has no place on the map: it sees chapter 10's sky.
std::vector<app::ProbeResult> AerialSky::probe(std::span<const app::ProbeRay> rays) {
  return SkyProgram(context_).probe(rays);
}

std::string AerialSky::explain() const {
  const Frames& frames = *frames_;
  std::string text = frames.graph.explain();
  const auto effect = [&text](const char* name, bool on, const std::string& why) {
    text += fmt::format("  {:<18} {:<4} {}\n", name, on ? "on" : "off", why);
  };
  const std::string none = "no [terrain] in scene";
  const auto& terrain = context_.scene.terrain;
  effect("terrain", terrain.has_value(),
         !terrain ? none
                  : fmt::format("[terrain] in scene: {} x {} samples of {:.0f} m, up to {:.2f} km",
                                frames.relief->map().size, frames.relief->map().size,
                                1e3 * terrain->extent_km / frames.relief->map().size, frames.relief->map().highest_km));
  effect("aerial perspective", terrain.has_value(),
         !terrain        ? none
         : frames.aerial ? "froxels before the terrain"
                         : "aerial.method is march: per pixel, no froxels");
  effect("terrain shadows", terrain && terrain->shadows,
         !terrain ? none : fmt::format("terrain.shadows = {}", terrain->shadows));
  effect("signs", terrain && terrain->signs_azimuth_deg,
         !terrain                     ? none
         : terrain->signs_azimuth_deg ? fmt::format("terrain.signs_azimuth_deg = {}", *terrain->signs_azimuth_deg)
                                      : "no terrain.signs_azimuth_deg");
  return text;
}

const gpu::Image* AerialSky::image(const std::string& name) const { return frames_->sky.image(name); }

}  // namespace welkin
