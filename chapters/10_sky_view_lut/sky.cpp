// The pass "sky" and chapter 10's program. See sky.hpp and docs/chapters/10_sky_view_lut.md.
#include "chapters/10_sky_view_lut/sky.hpp"

#include <algorithm>
#include <map>

#include "chapters/05_single_scattering/single_scattering.hpp"
#include "chapters/09_multiple_scattering_lut/all_orders_sky.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;

struct LookPush {
  CameraRays camera;
};

struct MarchPush {
  CameraRays camera;
  int32_t view_steps, table_steps, unused[2];
};

struct ProbePush {
  int32_t first, count, unused[2];
};

}  // namespace

std::vector<Knob> sky_knobs() {
  std::vector<Knob> knobs = joined(all_orders_knobs(), transmittance_knobs());
  for (Knob& knob : knobs) knob.ladder.clear();  // climbed in their own chapters
  return joined(std::move(knobs), sky_view_knobs());
}

// [sky_pass]
SkyPass::SkyPass(const app::Context& context, graph::Graph& graph)
    : context_(context),
      graph_(graph),
      air_(context, graph),
      transmittance_(context.scene.sun.disc ? std::make_unique<TransmittanceLut>(context, graph, air_) : nullptr),
      scattering_(wants_multiple_scattering(context.settings)
                      ? std::make_unique<MultipleScatteringLut>(context, graph, air_)
                      : nullptr),
      sky_view_(context, graph, air_, scattering_.get()) {
  rebuild();
}

void SkyPass::set_target(const gpu::Image& target, gpu::Use outside) {
  target_ = &target;
  write_targets();
  if (picture_) return graph_.replace(*picture_, target);
  picture_ = graph_.add("picture", target, outside);
  std::vector<graph::Access> accesses{
      {air_.resource(), gpu::kUniformRead}, {sky_view_.resource(), gpu::kSampledRead}, {*picture_, gpu::kComputeWrite}};
  if (transmittance_) accesses.push_back({transmittance_->resource(), gpu::kSampledRead});
  if (scattering_) accesses.push_back({scattering_->resource(), gpu::kSampledRead});
  graph_.add({.name = "sky",
              .accesses = std::move(accesses),
              .record =
                  [this](const app::Frame& frame) {
                    const VkExtent2D size{static_cast<uint32_t>(frame.camera.size.x),
                                          static_cast<uint32_t>(frame.camera.size.y)};
                    if (sky_view_.serves(frame.camera.altitude_km))
                      return gpu::dispatch_over(frame.commands, look_, look_set_, LookPush{frame.camera}, size);
                    const int table_steps =
                        scattering_ ? context_.settings.integer("multiple_scattering.view_steps") : 0;
                    const MarchPush push{frame.camera, context_.settings.integer("view.steps"), table_steps, {}};
                    gpu::dispatch_over(frame.commands, march_, march_set_, push, size);
                  },
              .changed = [](const app::Frame&) { return true; }});
}
// [/sky_pass]

void SkyPass::rebuild() {
  if (transmittance_) transmittance_->rebuild();
  if (scattering_) scattering_->rebuild();
  sky_view_.rebuild();
  const gpu::Device& device = context_.device;
  const bool disc = transmittance_ != nullptr;

  std::vector<gpu::Binding> bindings{{0, kUniform}, {1, kTable}, {3, kImage}};
  if (disc) bindings.push_back({2, kTable});
  gpu::Specialization constants = disc ? transmittance_->variant() : specialization(air_variant(context_.scene));
  constants.resize(6);  // of the table, or unused
  constants.push_back(sky_view_.unit());
  look_ = gpu::create_compute_pipeline(device, disc ? "10_sky_view_lut/sky_disc.comp" : "10_sky_view_lut/sky.comp",
                                       std::move(bindings), sizeof(LookPush), constants);
  look_set_ = gpu::create_descriptor_set(device, look_.set_layout, look_.bindings);
  gpu::write_buffer(device, look_set_, 0, kUniform, air_.buffer());
  gpu::write_sampled_image(device, look_set_, 1, sky_view_.image(), sky_view_.sampler());
  if (disc) gpu::write_sampled_image(device, look_set_, 2, transmittance_->image(), transmittance_->sampler());

  // The direct march is chapter 09's picture, or chapter 05's where one order is all there is.
  const std::string chapter = scattering_ ? "09_multiple_scattering_lut" : "05_single_scattering";
  std::vector<gpu::Binding> march_bindings{{0, kUniform}, {scattering_ ? 2u : 1u, kImage}};
  if (scattering_) march_bindings.push_back({1, kTable});
  gpu::Specialization march_constants =
      scattering_ ? scattering_->variant() : specialization(air_variant(context_.scene));
  march_constants.push_back(disc);
  if (!scattering_) march_constants.insert(march_constants.end(), {kRuleAdapted, 1u});
  march_ = gpu::create_compute_pipeline(device, chapter + "/image.comp", std::move(march_bindings), sizeof(MarchPush),
                                        march_constants);
  march_set_ = gpu::create_descriptor_set(device, march_.set_layout, march_.bindings);
  gpu::write_buffer(device, march_set_, 0, kUniform, air_.buffer());
  if (scattering_) gpu::write_sampled_image(device, march_set_, 1, scattering_->image(), scattering_->sampler());
  if (target_ != nullptr) write_targets();
}

void SkyPass::write_targets() {
  gpu::write_storage_image(context_.device, look_set_, 3, *target_);
  gpu::write_storage_image(context_.device, march_set_, scattering_ ? 2 : 1, *target_);
}

SkyProgram::SkyProgram(const app::Context& context) : context_(context) { rebuild(); }

void SkyProgram::rebuild() {
  const bool disc = context_.scene.sun.disc, all_orders = wants_multiple_scattering(context_.settings);
  if (graph_ && disc == disc_ && all_orders == all_orders_) return sky_->rebuild();
  disc_ = disc, all_orders_ = all_orders;
  sky_.reset();
  graph_ = std::make_unique<graph::Graph>(context_.inject);
  sky_ = std::make_unique<SkyPass>(context_, *graph_);
  if (target_ != nullptr) set_target(*target_);
}

void SkyProgram::set_target(const gpu::Image& target) {
  target_ = &target;
  sky_->set_target(target);
  graph_->want(sky_->resource());
  graph_->compile();
}

void SkyProgram::draw(const app::Frame& frame) {
  if (context_.settings.choice("tables") == "all") graph_->redo();
  graph_->execute(frame);
}

std::string SkyProgram::explain() const {
  return graph_->explain() +
         (disc_ ? ""
                : "  transmittance        off: the scene shows no sun's disc, and nothing else here asks the table\n") +
         (all_orders_ ? "" : "  multiple scattering  off: orders is 1\n");
}

const gpu::Image* SkyPass::image(const std::string& name) const {
  if (name == "sky_view") return &sky_view_.image();
  if (name == "transmittance" && transmittance_) return &transmittance_->image();
  if (name == "multiple_scattering" && scattering_) return &scattering_->image();
  return nullptr;
}

const gpu::Image* SkyProgram::image(const std::string& name) const { return sky_->image(name); }

// [probe]
// The table belongs to one altitude and one height of the sun: rays that share both are looked up together. The rest
// are marched.
std::vector<app::ProbeResult> SkyProgram::probe(std::span<const app::ProbeRay> rays) {
  const gpu::Device& device = context_.device;
  std::map<std::pair<double, double>, std::vector<size_t>> groups;
  std::vector<size_t> marched;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (sky_->sky_view().serves(rays[i].altitude_km))
      groups[{rays[i].altitude_km, rays[i].sun_zenith_deg}].push_back(i);
    else
      marched.push_back(i);
  }
  std::vector<app::ProbeResult> results(rays.size());
  if (!marched.empty()) {
    std::vector<app::ProbeRay> outside;
    for (const size_t i : marched) outside.push_back(rays[i]);
    const std::vector<app::ProbeResult> light = AllOrdersSky(context_).probe(outside);
    for (size_t k = 0; k < marched.size(); ++k) results[marched[k]] = light[k];
  }
  if (groups.empty()) return results;

  graph::Graph graph;
  AirBlock air(context_, graph);
  std::unique_ptr<MultipleScatteringLut> scattering;
  if (all_orders_) scattering = std::make_unique<MultipleScatteringLut>(context_, graph, air);
  SkyViewLut table(context_, graph, air, scattering.get());
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.push_back(table.unit());
  const gpu::ComputePipeline pipeline = gpu::create_compute_pipeline(
      device, "10_sky_view_lut/probe.comp", {{0, kUniform}, {1, kTable}, {2, kStorage}, {3, kStorage}},
      sizeof(ProbePush), constants);
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
  const size_t room = rays.size() - marched.size();
  const gpu::Buffer in = gpu::create_buffer(device, "rays", room * sizeof(MarchRay), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            gpu::Where::upload);
  const gpu::Buffer out = gpu::create_buffer(device, "results", room * 2 * sizeof(glm::vec4),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  gpu::write_buffer(device, set, 0, kUniform, air.buffer());
  gpu::write_sampled_image(device, set, 1, table.image(), table.sampler());
  gpu::write_buffer(device, set, 2, kStorage, in);
  gpu::write_buffer(device, set, 3, kStorage, out);

  ProbePush push{};
  const graph::Resource done = graph.add("results", out);
  graph.add({.name = "probe",
             .accesses = {{air.resource(), gpu::kUniformRead},
                          {table.resource(), gpu::kSampledRead},
                          {done, gpu::kComputeWrite}},
             .record =
                 [&](const app::Frame& frame) {
                   gpu::dispatch(frame.commands, pipeline, set, push, static_cast<uint32_t>(push.count + 63) / 64);
                   gpu::buffer_barrier(frame.commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
                 },
             .changed = [](const app::Frame&) { return true; }});
  graph.want(done);
  graph.compile();

  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::Timer timer(device);
  const gpu::Image no_target;
  for (const auto& [key, members] : groups) {
    push.first += push.count;
    push.count = static_cast<int32_t>(members.size());
    for (size_t k = 0; k < members.size(); ++k)
      in.as<MarchRay>()[static_cast<size_t>(push.first) + k] = march_ray(rays[members[k]], context_.scene.planet);
    const MarchRay& first = in.as<MarchRay>()[static_cast<size_t>(push.first)];
    CameraRays camera{};
    camera.altitude_km = first.view.w;
    camera.sun = first.sun;
    gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
      timer.begin_frame(commands);
      graph.execute({commands, no_target, camera, timer, 0, 0, 0.0});
    });
    for (size_t k = 0; k < members.size(); ++k) {
      const size_t i = static_cast<size_t>(push.first) + k;
      results[members[k]] = {glm::dvec3(out.as<glm::vec4>()[2 * i]), glm::dvec3(out.as<glm::vec4>()[2 * i + 1])};
    }
  }
  return results;
}
// [/probe]

}  // namespace welkin
