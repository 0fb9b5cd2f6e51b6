// Images of first surfaces for the path tracer. See terrain_truth.hpp.
#include "chapters/11_aerial_perspective/terrain_truth.hpp"

#include <bit>
#include <glm/trigonometric.hpp>

#include "chapters/07_ground_truth/ground_truth.hpp"
#include "chapters/11_aerial_perspective/relief.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

// Push constants of surfaces.comp.
struct SurfacesPush {
  CameraRays camera;
  glm::vec4 position, east, north;
};

class TerrainTruth : public app::Program {
 public:
  explicit TerrainTruth(const app::Context& context)
      : context_(context), relief_(context, graph_), tracer_(context, true) {
    make_pipeline();
  }

  void set_target(const gpu::Image& target) override {
    relief_.set_size(target.size);
    for (gpu::Image* image : {&normals_, &albedos_})
      *image = gpu::create_image(context_.device, "first surfaces", target.size, VK_FORMAT_R32G32B32A32_SFLOAT,
                                 VK_IMAGE_USAGE_STORAGE_BIT);
    gpu::write_storage_image(context_.device, set_, 0, relief_.distance());
    gpu::write_sampled_image(context_.device, set_, 1, relief_.slopes(), relief_.sampler());
    gpu::write_sampled_image(context_.device, set_, 2, relief_.cover(), relief_.sampler());
    gpu::write_storage_image(context_.device, set_, 3, normals_);
    gpu::write_storage_image(context_.device, set_, 4, albedos_);
    tracer_.set_target(target);
    tracer_.set_surfaces({&normals_, &albedos_});
    if (compiled_) {
      graph_.replace(normals_resource_, normals_);
      graph_.replace(albedos_resource_, albedos_);
    } else {
      compile();
    }
  }

  void draw(const app::Frame& frame) override {
    const Lifted eye = lifted(frame, relief_.map(), context_.scene.planet.ground_radius_km);
    const app::Frame seen{frame.commands, frame.target, eye.camera,    frame.timer,
                          frame.index,    frame.seed,   frame.seconds, eye.position_km};
    graph_.execute(seen);
    for (const gpu::Image* image : {&normals_, &albedos_})
      gpu::image_barrier(frame.commands, image->handle, gpu::kComputeWrite, gpu::kComputeRead);
    tracer_.draw(seen);
  }

  void rebuild() override {
    relief_.rebuild();
    make_pipeline();
    if (compiled_) graph_.redo();
    tracer_.rebuild();
  }

  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override {
    return GroundTruth(context_).probe(rays);
  }
  std::string explain() const override { return graph_.explain() + tracer_.explain(); }

 private:
  // [surfaces]
  void compile() {
    constexpr gpu::Use traced{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                              VK_IMAGE_LAYOUT_GENERAL};  // between frames
    normals_resource_ = graph_.add("normals and distances", normals_, traced);
    albedos_resource_ = graph_.add("albedos", albedos_, traced);
    graph_.add({.name = "surfaces",
                .accesses = {{relief_.distance_resource(), gpu::kComputeRead},
                             {normals_resource_, gpu::kComputeWrite},
                             {albedos_resource_, gpu::kComputeWrite}},
                .record = [this](const app::Frame& frame) { draw_surfaces(frame); },
                .changed = [](const app::Frame&) { return true; }});  // the ground's albedo is a knob
    graph_.want(normals_resource_);
    graph_.compile();
    compiled_ = true;
  }

  void draw_surfaces(const app::Frame& frame) const {
    const Scene& scene = context_.scene;
    const Standpoint at = standpoint(frame, scene.planet.ground_radius_km);
    const glm::dvec3 bare(scene.planet.ground_albedo);
    const SurfacesPush push{frame.camera, {at.position_km, bare.r}, {at.east, bare.g}, {at.north, bare.b}};
    gpu::dispatch_over(frame.commands, pipeline_, set_, push, frame.target.size);
  }
  // [/surfaces]

  void make_pipeline() {
    const Scene& scene = context_.scene;
    const std::optional<double>& signs = scene.terrain->signs_azimuth_deg;
    const auto bits = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); };
    pipeline_ = gpu::create_compute_pipeline(context_.device, "11_aerial_perspective/surfaces.comp",
                                             {{0, kImage}, {1, kSampled}, {2, kSampled}, {3, kImage}, {4, kImage}},
                                             sizeof(SurfacesPush),
                                             {bits(signs ? glm::radians(*signs) : -1e3), bits(scene.terrain->extent_km),
                                              bits(scene.planet.ground_radius_km)});
    if (set_.handle == VK_NULL_HANDLE)
      set_ = gpu::create_descriptor_set(context_.device, pipeline_.set_layout, pipeline_.bindings);
  }

  const app::Context context_;
  graph::Graph graph_;
  Relief relief_;
  GroundTruth tracer_;
  gpu::Image normals_, albedos_;
  graph::Resource normals_resource_ = 0, albedos_resource_ = 0;
  bool compiled_ = false;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
};

}  // namespace

app::Truth terrain_truth() {
  app::Truth truth = path_truth();
  truth.knobs = joined(truth.knobs, terrain_knobs());
  truth.make = [](const app::Context& context) -> std::unique_ptr<app::Program> {
    if (context.scene.terrain) return std::make_unique<TerrainTruth>(context);
    return std::make_unique<GroundTruth>(context);
  };
  return truth;
}

}  // namespace welkin
