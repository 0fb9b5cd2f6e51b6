// Single rays. An invocation traces one block of a few paths of one ray and sums them in float32; the host sums the
// blocks in double.
#include "chapters/05_single_scattering/probe.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "chapters/07_ground_truth/ground_truth.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr int64_t kInvocations = 1 << 18;  // of one dispatch; they write 12 MiB of results

struct ProbePush {
  int32_t first_ray, blocks, samples, invocations;
  int32_t orders, seed, first_block, unused;
};

struct Sum {
  glm::dvec3 radiance{0.0}, squares{0.0}, transmittance{1.0};
  double unfinished = 0.0;
};

}  // namespace

// [probe]
std::vector<app::ProbeResult> GroundTruth::probe(std::span<const app::ProbeRay> rays) {
  const gpu::Device& device = context_.device;
  const Settings& settings = context_.settings;
  const gpu::ComputePipeline pipeline =
      gpu::create_compute_pipeline(device, "07_ground_truth/probe.comp", {{0, kUniform}, {1, kStorage}, {2, kStorage}},
                                   sizeof(ProbePush), variant());
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  const Batches plan = batches_of(settings.integer("probe.samples"), settings.integer("tracking"));
  const int64_t invocations = std::min<int64_t>(kInvocations, int64_t{plan.count} * static_cast<int64_t>(rays.size()));
  const gpu::Buffer in = gpu::create_buffer(device, "rays", rays.size() * sizeof(MarchRay),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload);
  const gpu::Buffer out = gpu::create_buffer(device, "results", invocations * 3 * sizeof(glm::vec4),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  gpu::write_buffer(device, set, 0, kUniform, air_);
  gpu::write_buffer(device, set, 1, kStorage, in);
  gpu::write_buffer(device, set, 2, kStorage, out);
  for (size_t i = 0; i < rays.size(); ++i) in.as<MarchRay>()[i] = march_ray(rays[i], context_.scene.planet);

  std::vector<Sum> sums(rays.size());
  const auto run = [&](int first_ray, int ray_count, int first_block, int blocks) {
    const int32_t count = ray_count * blocks;
    const ProbePush push{first_ray, blocks, plan.samples, count, settings.integer("orders"), 1, first_block, 0};
    gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
      update_air(commands);
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set.handle, 0, nullptr);
      vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
      vkCmdDispatch(commands, (count + 63) / 64, 1, 1);
      gpu::buffer_barrier(commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
    });
    for (int32_t i = 0; i < count; ++i) {
      Sum& sum = sums[first_ray + i / blocks];
      const glm::vec4* result = &out.as<glm::vec4>()[3 * i];
      sum.radiance += glm::dvec3(result[0]);
      sum.squares += glm::dvec3(result[1]);
      sum.transmittance = glm::dvec3(result[2]);
      sum.unfinished += result[0].w;
    }
  };
  // A dispatch takes whole rays where their blocks fit, else one ray and as many of its blocks as fit.
  const int rays_at_once = static_cast<int>(std::max<int64_t>(1, kInvocations / plan.count));
  for (int first = 0; first < static_cast<int>(rays.size()); first += rays_at_once) {
    const int count = std::min(rays_at_once, static_cast<int>(rays.size()) - first);
    for (int block = 0; block < plan.count; block += kInvocations)
      run(first, count, block, std::min<int>(kInvocations, plan.count - block));
  }

  const double n = double(plan.count) * plan.samples;
  std::vector<app::ProbeResult> results;
  double unfinished = 0.0;
  for (const Sum& sum : sums) {
    const glm::dvec3 mean = sum.radiance / n, variance = glm::max(sum.squares / n - mean * mean, 0.0);
    results.push_back({mean, sum.transmittance, glm::sqrt(variance / (n - 1.0))});
    unfinished += sum.unfinished;
  }
  if (unfinished > 0.0)
    fail(
        "--probe: the driver cut {:g} paths short: radiance would be too low; a tracking with fewer steps is needed "
        "(closed_form)",
        unfinished);
  return results;
}
// [/probe]

}  // namespace welkin
