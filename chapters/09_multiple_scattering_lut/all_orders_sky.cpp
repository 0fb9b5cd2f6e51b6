// The passes of chapter 09's pictures and probes. See all_orders_sky.hpp.
#include "chapters/09_multiple_scattering_lut/all_orders_sky.hpp"

#include <algorithm>
#include <optional>

#include "chapters/05_single_scattering/single_scattering.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;

struct ImagePush {
  CameraRays camera;
  int32_t view_steps, source_steps, unused[2];
};

// Chapter 05's shader has the count second, this chapter's third.
struct ProbePush {
  int32_t view_steps, source_steps_or_count, count, unused;
};

}  // namespace

std::vector<Knob> all_orders_knobs() {
  std::vector<Knob> knobs;
  for (Knob& knob : march_knobs())
    if (knob.name == "view.steps") knobs.push_back(std::move(knob));
  knobs.push_back(
      {.name = "tables",
       .meaning = "what a frame computes: only what something changed for, or everything (to see what it costs)",
       .choices = {"changed", "all"}});
  return joined(std::move(knobs), multiple_scattering_knobs());
}

// [frames]
// A graph: air, the table if it is wanted, and later one pass that reads them.
struct AllOrdersSky::Frames {
  explicit Frames(const app::Context& context) : graph(context.inject), air(context, graph) {
    if (wants_multiple_scattering(context.settings)) table.emplace(context, graph, air);
  }
  std::vector<graph::Access> reads() const {
    std::vector<graph::Access> accesses{{air.resource(), gpu::kUniformRead}};
    if (table) accesses.push_back({table->resource(), gpu::kSampledRead});
    return accesses;
  }
  // Block 0, table 1 if there is one; the next free slot.
  uint32_t write_inputs(const gpu::Device& device, const gpu::DescriptorSet& to) const {
    gpu::write_buffer(device, to, 0, kUniform, air.buffer());
    if (table) gpu::write_sampled_image(device, to, 1, table->image(), table->sampler());
    return table ? 2 : 1;
  }

  graph::Graph graph;
  AirBlock air;
  std::optional<MultipleScatteringLut> table;
  graph::Resource picture = 0;
  bool has_picture = false;
  gpu::ComputePipeline image;
  gpu::DescriptorSet set;
};

AllOrdersSky::AllOrdersSky(const app::Context& context) : context_(context) { rebuild(); }
AllOrdersSky::~AllOrdersSky() = default;

// Without the table single scattering is all there is, and chapter 05's shaders draw it.
gpu::ComputePipeline AllOrdersSky::make_pipeline(const Frames& frames, bool probe) const {
  std::vector<gpu::Binding> bindings{{0, kUniform}};
  gpu::Specialization constants;
  if (frames.table) {
    bindings.push_back({1, kTable});
    constants = frames.table->variant();
    constants.push_back(context_.scene.sun.disc);
  } else {
    constants = specialization(air_variant(context_.scene));
    constants.insert(constants.end(), {context_.scene.sun.disc, kRuleAdapted, 1u});
  }
  for (int i = 0; i < (probe ? 2 : 1); ++i)
    bindings.push_back({static_cast<uint32_t>(bindings.size()), probe ? kStorage : kImage});
  const std::string chapter = frames.table ? "09_multiple_scattering_lut" : "05_single_scattering";
  return gpu::create_compute_pipeline(context_.device, chapter + (probe ? "/probe.comp" : "/image.comp"),
                                      std::move(bindings), probe ? sizeof(ProbePush) : sizeof(ImagePush), constants);
}

void AllOrdersSky::rebuild() {
  if (!frames_ || frames_->table.has_value() != wants_multiple_scattering(context_.settings)) {
    frames_.reset();
    frames_ = std::make_unique<Frames>(context_);
  } else if (frames_->table) {
    frames_->table->rebuild();
  }
  frames_->image = make_pipeline(*frames_, false);
  frames_->set = gpu::create_descriptor_set(context_.device, frames_->image.set_layout, frames_->image.bindings);
  frames_->write_inputs(context_.device, frames_->set);
  if (target_ != nullptr) set_target(*target_);
}
// [/frames]

void AllOrdersSky::set_target(const gpu::Image& target) {
  target_ = &target;
  Frames& frames = *frames_;
  gpu::write_storage_image(context_.device, frames.set, frames.table ? 2 : 1, target);
  if (frames.has_picture) return frames.graph.replace(frames.picture, target);
  frames.has_picture = true;
  // Between frames the picture is displayed; what it held is not needed.
  frames.picture = frames.graph.add("picture", target, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT});
  std::vector<graph::Access> accesses = frames.reads();
  accesses.push_back({frames.picture, gpu::kComputeWrite});
  frames.graph.add({.name = "march",
                    .accesses = std::move(accesses),
                    .record =
                        [this](const app::Frame& frame) {
                          const int table_steps =
                              frames_->table ? context_.settings.integer("multiple_scattering.view_steps") : 0;
                          const ImagePush push{frame.camera, context_.settings.integer("view.steps"), table_steps, {}};
                          gpu::dispatch_over(frame.commands, frames_->image, frames_->set, push, frame.target.size);
                        },
                    .changed = [](const app::Frame&) { return true; }});
  frames.graph.want(frames.picture);
  frames.graph.compile();
}

void AllOrdersSky::draw(const app::Frame& frame) {
  if (context_.settings.choice("tables") == "all") frames_->graph.redo();
  frames_->graph.execute(frame);
}

std::string AllOrdersSky::explain() const {
  return frames_->graph.explain() +
         (frames_->table
              ? frames_->table->explain()
              : "  multiple scattering  off: orders is 1, so there is no table and chapter 05's shader draws\n");
}

const gpu::Image* AllOrdersSky::image(const std::string& name) const {
  return name == "multiple_scattering" && frames_->table ? &frames_->table->image() : nullptr;
}

// [probe]
// A graph of its own: air, table, rays.
std::vector<app::ProbeResult> AllOrdersSky::probe(std::span<const app::ProbeRay> rays) {
  const gpu::Device& device = context_.device;
  Frames frames(context_);
  constexpr size_t kBatch = 1 << 16;
  const size_t room = std::min(kBatch, rays.size());
  const gpu::Buffer in = gpu::create_buffer(device, "rays", room * sizeof(MarchRay), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            gpu::Where::upload);
  const gpu::Buffer out = gpu::create_buffer(device, "results", room * 2 * sizeof(glm::vec4),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  const gpu::ComputePipeline pipeline = make_pipeline(frames, true);
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
  const uint32_t slot = frames.write_inputs(device, set);
  gpu::write_buffer(device, set, slot, kStorage, in);
  gpu::write_buffer(device, set, slot + 1, kStorage, out);

  int32_t count = 0;
  const graph::Resource results = frames.graph.add("results", out);
  std::vector<graph::Access> accesses = frames.reads();
  accesses.push_back({results, gpu::kComputeWrite});
  frames.graph.add({.name = "probe",
                    .accesses = std::move(accesses),
                    .record =
                        [&](const app::Frame& frame) {
                          const int table_steps =
                              frames.table ? context_.settings.integer("multiple_scattering.view_steps") : count;
                          const ProbePush push{context_.settings.integer("view.steps"), table_steps, count, 0};
                          gpu::dispatch(frame.commands, pipeline, set, push, static_cast<uint32_t>(count + 63) / 64);
                          gpu::buffer_barrier(frame.commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
                        },
                    .changed = [](const app::Frame&) { return true; }});
  frames.graph.want(results);
  frames.graph.compile();

  std::vector<app::ProbeResult> light;
  light.reserve(rays.size());
  for (size_t first = 0; first < rays.size(); first += kBatch) {
    count = static_cast<int32_t>(std::min(kBatch, rays.size() - first));
    for (int32_t i = 0; i < count; ++i) in.as<MarchRay>()[i] = march_ray(rays[first + i], context_.scene.planet);
    execute_once(device, frames.graph);
    for (int32_t i = 0; i < count; ++i)
      light.push_back({glm::dvec3(out.as<glm::vec4>()[2 * i]), glm::dvec3(out.as<glm::vec4>()[2 * i + 1])});
  }
  return light;
}
// [/probe]

}  // namespace welkin
