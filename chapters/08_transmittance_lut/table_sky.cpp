// The passes of chapter 08's pictures and probes. See table_sky.hpp.
#include "chapters/08_transmittance_lut/table_sky.hpp"

#include <algorithm>
#include <utility>

#include "chapters/05_single_scattering/single_scattering.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;

struct ImagePush {
  CameraRays camera;
  int32_t view_steps, unused[3];
};

struct ProbePush {
  int32_t view_steps, count, unused[2];
};

}  // namespace

std::vector<Knob> table_sky_knobs() {
  std::vector<Knob> knobs;
  for (Knob& knob : march_knobs())
    if (knob.name != "light.steps") knobs.push_back(std::move(knob));
  return joined(std::move(knobs), transmittance_knobs());
}

// [passes]
TableSky::TableSky(const app::Context& context)
    : context_(context), graph_(context.inject), air_(context_, graph_), table_(context_, graph_, air_) {
  make_pipeline();
}

void TableSky::set_target(const gpu::Image& target) {
  gpu::write_storage_image(context_.device, image_set_, 2, target);
  if (std::exchange(target_, &target) != nullptr) return graph_.replace(picture_, target);
  // Between frames the picture is displayed; what it held is not needed.
  picture_ = graph_.add("picture", target, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT});
  graph_.add({.name = "march",
              .accesses = {{air_.resource(), gpu::kUniformRead},
                           {table_.resource(), gpu::kSampledRead},
                           {picture_, gpu::kComputeWrite}},
              .record =
                  [this](const app::Frame& frame) {
                    const ImagePush push{frame.camera, context_.settings.integer("view.steps"), {}};
                    gpu::dispatch_over(frame.commands, image_, image_set_, push, frame.target.size);
                  },
              .changed = [](const app::Frame&) { return true; }});
  graph_.want(picture_);
  graph_.compile();
}

void TableSky::draw(const app::Frame& frame) { graph_.execute(frame); }
// [/passes]

// [rebuild]
gpu::Specialization TableSky::variant() const {
  gpu::Specialization constants = table_.variant();
  constants.push_back(context_.scene.sun.disc);
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("rule")));
  return constants;
}

void TableSky::rebuild() {
  table_.rebuild();
  make_pipeline();
}

void TableSky::make_pipeline() {
  image_ = gpu::create_compute_pipeline(context_.device, "08_transmittance_lut/image.comp",
                                        {{0, kUniform}, {1, kTable}, {2, kImage}}, sizeof(ImagePush), variant());
  image_set_ = gpu::create_descriptor_set(context_.device, image_.set_layout, image_.bindings);
  gpu::write_buffer(context_.device, image_set_, 0, kUniform, air_.buffer());
  gpu::write_sampled_image(context_.device, image_set_, 1, table_.image(), table_.sampler());  // it may be another one
  if (target_ != nullptr) gpu::write_storage_image(context_.device, image_set_, 2, *target_);
}
// [/rebuild]

// [probe]
// A graph of its own: air, table, rays.
std::vector<app::ProbeResult> TableSky::probe(std::span<const app::ProbeRay> rays) {
  const gpu::Device& device = context_.device;
  graph::Graph graph;
  AirBlock air(context_, graph);
  TransmittanceLut table(context_, graph, air);
  constexpr size_t kBatch = 1 << 16;
  const size_t room = std::min(kBatch, rays.size());
  const gpu::Buffer in = gpu::create_buffer(device, "rays", room * sizeof(MarchRay), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            gpu::Where::upload);
  const gpu::Buffer out = gpu::create_buffer(device, "results", room * 2 * sizeof(glm::vec4),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  const gpu::ComputePipeline pipeline = gpu::create_compute_pipeline(
      device, "08_transmittance_lut/probe.comp", {{0, kUniform}, {1, kTable}, {2, kStorage}, {3, kStorage}},
      sizeof(ProbePush), variant());
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
  gpu::write_buffer(device, set, 0, kUniform, air.buffer());
  gpu::write_sampled_image(device, set, 1, table.image(), table.sampler());
  gpu::write_buffer(device, set, 2, kStorage, in);
  gpu::write_buffer(device, set, 3, kStorage, out);

  uint32_t count = 0;
  const graph::Resource results = graph.add("results", out);
  graph.add({.name = "probe",
             .accesses = {{air.resource(), gpu::kUniformRead},
                          {table.resource(), gpu::kSampledRead},
                          {results, gpu::kComputeWrite}},
             .record =
                 [&](const app::Frame& frame) {
                   const ProbePush push{context_.settings.integer("view.steps"), static_cast<int32_t>(count), {}};
                   gpu::dispatch(frame.commands, pipeline, set, push, (count + 63) / 64);
                   gpu::buffer_barrier(frame.commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
                 },
             .changed = [](const app::Frame&) { return true; }});
  graph.want(results);
  graph.compile();

  std::vector<app::ProbeResult> light;
  light.reserve(rays.size());
  for (size_t first = 0; first < rays.size(); first += kBatch) {
    count = static_cast<uint32_t>(std::min(kBatch, rays.size() - first));
    for (uint32_t i = 0; i < count; ++i) in.as<MarchRay>()[i] = march_ray(rays[first + i], context_.scene.planet);
    execute_once(device, graph);
    for (uint32_t i = 0; i < count; ++i)
      light.push_back({glm::dvec3(out.as<glm::vec4>()[2 * i]), glm::dvec3(out.as<glm::vec4>()[2 * i + 1])});
  }
  return light;
}
// [/probe]

}  // namespace welkin
