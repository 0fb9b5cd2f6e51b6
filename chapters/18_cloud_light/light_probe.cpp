// Rays of --probe through lit clouds: paths, march, or order 1 converged. See cloud_light.hpp.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "chapters/05_single_scattering/probe.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "chapters/16_noise/noise.hpp"
#include "chapters/18_cloud_light/cloud_light.hpp"
#include "common/graph/composition.hpp"

namespace welkin {
namespace {

constexpr int kMostInvocations = 1 << 17;
constexpr int kFirstOrderParts = 32;

enum Method { kPaths, kMarch, kFirstOrder };

struct LightRayItem {
  CloudRayItem ray;
  glm::vec4 sun;  // w: the ground's albedo
};

struct ProbePush {
  CloudLightPush march;
  int32_t method, blocks, samples, invocations;
  int32_t orders, first_block, seed, unused;
};

struct LightProbe {
  graph::Resource rays, results;
  std::shared_ptr<ProbePush> push;
};

// How the work is cut: blocks a ray, paths a block.
struct Work {
  Method method = kMarch;
  int blocks = 1, samples = 1;
};

Work work_of(const Settings& settings) {
  if (settings.integer("orders") == 1) return {kFirstOrder, kFirstOrderParts, 1};
  if (settings.choice("cloud.method") == "march") return {};
  // One path an invocation: a thick cloud's longest comes near what a software driver's loops allow.
  return {kPaths, settings.integer("probe.samples"), 1};
}

app::Effect probe_effect(size_t rays, size_t invocations) {
  app::Effect effect{.name = "cloud light probe", .chapter = 18};
  effect.declare = [rays, invocations](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    LightProbe probe{.push = std::make_shared<ProbePush>()};
    probe.rays = builder.graph.add_filled("light rays",
                                          gpu::create_buffer(context.device, "light rays", rays * sizeof(LightRayItem),
                                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload));
    probe.results = builder.graph.add_buffer(
        "cloud light", {invocations * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback});
    graph::Step step{.shader = "18_cloud_light/probe.comp",
                     .bindings = {{"Rays", probe.rays},
                                  {"Results", probe.results},
                                  {"cloud_bounds", board.get<CloudBounds>("cloud bounds").image}}};
    bind_clouds(step, board.get<CloudBodies>("clouds"));
    step.record = [push = probe.push](const graph::Recorder& r) {
      r.push(*push).dispatch(static_cast<uint32_t>(push->invocations + 63) / 64);
    };
    add_probe_pass(builder, probe.results, std::move(step));
    board.offer(std::move(probe));
  };
  return effect;
}

struct Sum {
  double radiance = 0.0, squares = 0.0, unfinished = 0.0;
};

// [run]
// Rays a few at a time, or one ray a few blocks at a time.
std::vector<Sum> run(const app::Context& context, std::span<const app::ProbeRay> rays, const Work& work) {
  std::vector<Sum> sums(rays.size());
  const int blocks_at_once = std::min(work.blocks, kMostInvocations);
  const size_t rays_at_once =
      std::clamp<size_t>(static_cast<size_t>(kMostInvocations / blocks_at_once), 1, rays.size());
  app::Composition composition(context, {noise_textures(), weather_texture(), clouds(), cloud_bounds(),
                                         probe_effect(rays_at_once, rays_at_once * blocks_at_once)});
  const LightProbe& probe = *composition.find<LightProbe>();
  const double ceiling_km = composition.find<CloudBodies>()->ceiling_km;
  const glm::dvec3 albedo = context.scene.planet.ground_albedo;
  for (size_t first = 0; first < rays.size(); first += rays_at_once) {
    const size_t count = std::min(rays_at_once, rays.size() - first);
    const std::span<LightRayItem> in = composition.graph().buffer(probe.rays).as<LightRayItem>();
    for (size_t i = 0; i < count; ++i)
      in[i] = {cloud_ray_item(rays[first + i], context.scene.planet.ground_radius_km, ceiling_km),
               glm::vec4(rays[first + i].sun, (albedo.x + albedo.y + albedo.z) / 3.0)};
    for (int block = 0; block < work.blocks; block += blocks_at_once) {
      const int blocks = std::min(blocks_at_once, work.blocks - block);
      *probe.push = {cloud_light_push(context.settings),
                     work.method,
                     blocks,
                     work.samples,
                     static_cast<int32_t>(count) * blocks,
                     context.settings.integer("orders"),
                     block,
                     1,
                     0};
      composition.execute_once();
      const std::span<glm::vec4> out = composition.graph().buffer(probe.results).as<glm::vec4>();
      for (size_t i = 0; i < count * blocks; ++i) {
        Sum& sum = sums[first + i / blocks];
        sum.radiance += out[i].x, sum.squares += out[i].y, sum.unfinished += out[i].z;
      }
    }
  }
  return sums;
}
// [/run]

}  // namespace

// [probe]
std::vector<app::ProbeResult> probe_cloud_light(const app::Context& context, std::span<const app::ProbeRay> rays) {
  std::vector<app::ProbeResult> results(rays.size(), {glm::dvec3(0.0), glm::dvec3(1.0)});
  if (!context.scene.media.empty()) results = probe_sky(context, rays);
  if (rays.empty() || bodies_of(context.scene).empty()) return results;
  const std::vector<double> depths = cloud_optical_depths(context, rays);
  const Work work = work_of(context.settings);
  const std::vector<Sum> sums = run(context, rays, work);
  const glm::dvec3 sunlight = context.scene.sun.irradiance;
  const double n = work.method == kPaths ? double(work.blocks) * work.samples : 1.0;
  double unfinished = 0.0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const double through = std::exp(-depths[i]), mean = sums[i].radiance / n;
    results[i].radiance = results[i].radiance * through + sunlight * mean;
    results[i].transmittance *= through;
    if (work.method == kPaths)
      results[i].standard_error =
          sunlight * std::sqrt(std::max(sums[i].squares / n - mean * mean, 0.0) / std::max(n - 1.0, 1.0));
    unfinished += sums[i].unfinished;
  }
  if (unfinished > 0.0)
    fail(
        "--probe: the driver cut {:g} paths short: radiance would be too low; accepted is a thinner cloud, fewer "
        "orders "
        "or a device that is not a software one",
        unfinished);
  return results;
}
// [/probe]

}  // namespace welkin
