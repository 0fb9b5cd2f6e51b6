// The march's passes on the device. See single_scattering.hpp and docs/chapters/05_single_scattering.md.
#include "chapters/05_single_scattering/single_scattering.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "shaders/interop/camera.h"

namespace welkin {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
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

// [knobs]
// The product of the largest counts stays below 65,535: a software driver ends loops there, without a word.
std::vector<Knob> march_knobs() {
  return {{.name = "view.steps",
           .unit = "steps",
           .meaning = "samples along the view ray",
           .minimum = 1,
           .maximum = 512,
           .initial = 32,
           .integer = true,
           .ladder = {8, 16, 32, 64, 128}},
          {.name = "light.steps",
           .unit = "steps",
           .meaning = "samples along each path to the sun (the adapted rule has a closed form instead)",
           .minimum = 1,
           .maximum = 120,
           .initial = 8,
           .integer = true,
           .ladder = {4, 8, 16},
           .rebuilds = true},
          {.name = "rule",
           .meaning = "where the samples sit and what they weigh",
           .initial = kRuleAdapted,
           .choices = {"left", "midpoint", "offset_0.3", "nonuniform", "gauss_legendre", "adapted"},
           .ladder = {0, 1, 2, 3, 4, 5},
           .rebuilds = true}};
}
// [/knobs]

// [ray]
MarchRay march_ray(const app::ProbeRay& ray, const Planet& planet) {
  const double top_km = planet.top_radius_km - planet.ground_radius_km;
  const auto polar = [](double zenith, double azimuth) {
    return glm::dvec3(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
  };
  const double view_zenith = glm::radians(ray.view_zenith_deg);
  glm::dvec3 sun = polar(glm::radians(ray.sun_zenith_deg), glm::radians(ray.relative_azimuth_deg));
  if (ray.altitude_km <= top_km) return {{polar(view_zenith, 0.0), ray.altitude_km}, {sun, 0.0}};

  const MarchRay miss{{0.0, 0.0, 1.0, top_km}, {sun, 0.0}};
  const double closest_km = (planet.ground_radius_km + ray.altitude_km) * std::sin(view_zenith);
  if (ray.view_zenith_deg <= 90.0 || closest_km >= planet.top_radius_km) return miss;
  // At the entry the line makes a larger angle with the vertical: sin(zenith) = closest / top radius, looking down. The
  // local frame turns by the difference about the horizontal axis across the view.
  const double entry_zenith = glm::radians(180.0) - std::asin(closest_km / planet.top_radius_km);
  const double turn = entry_zenith - view_zenith;
  sun = {std::cos(turn) * sun.x + std::sin(turn) * sun.z, sun.y, std::cos(turn) * sun.z - std::sin(turn) * sun.x};
  return {{polar(entry_zenith, 0.0), top_km}, {sun, 0.0}};
}
// [/ray]

SingleScattering::SingleScattering(const app::Context& context)
    : context_(context),
      air_(gpu::create_buffer(context.device, "atmosphere", sizeof(interop::Atmosphere),
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              gpu::Where::device)) {
  rebuild();
}

// [rebuild]
gpu::Specialization SingleScattering::variant() const {
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.push_back(context_.scene.sun.disc);
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("rule")));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("light.steps")));
  return constants;
}

void SingleScattering::rebuild() {
  image_ = gpu::create_compute_pipeline(context_.device, "05_single_scattering/image.comp",
                                        {{0, kUniform}, {1, kImage}}, sizeof(ImagePush), variant());
  if (image_set_.handle != VK_NULL_HANDLE) return;
  image_set_ = gpu::create_descriptor_set(context_.device, image_.set_layout, image_.bindings);
  gpu::write_buffer(context_.device, image_set_, 0, kUniform, air_);
}
// [/rebuild]

void SingleScattering::set_target(const gpu::Image& target) {
  gpu::write_storage_image(context_.device, image_set_, 1, target);
}

// Writes the atmosphere into its block. Earlier frames may still read it: their reads come first.
void SingleScattering::update_air(VkCommandBuffer commands) const {
  interop::Atmosphere air = make_atmosphere(context_.scene);
  if (context_.inject == "wrong-constant") air.rayleigh_scattering.x *= 1.1f;
  gpu::buffer_barrier(commands, air_.handle, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT}, gpu::kUpdate);
  vkCmdUpdateBuffer(commands, air_.handle, 0, sizeof air, &air);
  gpu::buffer_barrier(commands, air_.handle, gpu::kUpdate, gpu::kUniformRead);
}

// [draw]
void SingleScattering::draw(const app::Frame& frame) {
  update_air(frame.commands);
  constexpr gpu::Use earlier_read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};
  gpu::image_barrier(frame.commands, frame.target.handle, earlier_read, gpu::kComputeWrite);
  const gpu::TimedPass pass(frame.timer, frame.commands, "march");
  const ImagePush push{frame.camera, context_.settings.integer("view.steps"), {}};
  gpu::dispatch_over(frame.commands, image_, image_set_, push, frame.target.size);
}
// [/draw]

std::vector<app::ProbeResult> SingleScattering::probe(std::span<const app::ProbeRay> rays) {
  const gpu::Device& device = context_.device;
  const gpu::ComputePipeline pipeline =
      gpu::create_compute_pipeline(device, "05_single_scattering/probe.comp",
                                   {{0, kUniform}, {1, kStorage}, {2, kStorage}}, sizeof(ProbePush), variant());
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  // A batch at a time: a million rays fit any device's largest storage buffer many times over.
  constexpr size_t kBatch = 1 << 16;
  const size_t room = std::min(kBatch, rays.size());
  const gpu::Buffer in = gpu::create_buffer(device, "rays", room * sizeof(MarchRay), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                            gpu::Where::upload);
  const gpu::Buffer out = gpu::create_buffer(device, "results", room * 2 * sizeof(glm::vec4),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  gpu::write_buffer(device, set, 0, kUniform, air_);
  gpu::write_buffer(device, set, 1, kStorage, in);
  gpu::write_buffer(device, set, 2, kStorage, out);

  std::vector<app::ProbeResult> results;
  results.reserve(rays.size());
  for (size_t first = 0; first < rays.size(); first += kBatch) {
    const uint32_t count = static_cast<uint32_t>(std::min(kBatch, rays.size() - first));
    for (uint32_t i = 0; i < count; ++i) in.as<MarchRay>()[i] = march_ray(rays[first + i], context_.scene.planet);
    const ProbePush push{context_.settings.integer("view.steps"), static_cast<int32_t>(count), {}};
    gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
      update_air(commands);
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set.handle, 0, nullptr);
      vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
      vkCmdDispatch(commands, (count + 63) / 64, 1, 1);
      gpu::buffer_barrier(commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
    });
    for (uint32_t i = 0; i < count; ++i)
      results.push_back({glm::dvec3(out.as<glm::vec4>()[2 * i]), glm::dvec3(out.as<glm::vec4>()[2 * i + 1])});
  }
  return results;
}

}  // namespace welkin
