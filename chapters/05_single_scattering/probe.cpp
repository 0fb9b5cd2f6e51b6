// Rays in batches. See probe.hpp.
#include "chapters/05_single_scattering/probe.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace welkin {
namespace {

constexpr size_t kBatch = 1 << 16;  // rays; far below what the smallest device's storage buffer holds

app::Effect probe_buffers(size_t room) {
  app::Effect effect{.name = "probe rays", .chapter = 5};
  effect.declare = [room](app::Builder& builder, app::Board& board) {
    const gpu::Device& device = builder.context.device;
    ProbeBuffers probe{.range = std::make_shared<ProbeBuffers::Range>()};
    probe.rays =
        builder.graph.add_filled("rays", gpu::create_buffer(device, "rays", room * sizeof(MarchRay),
                                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload));
    probe.results = builder.graph.add_buffer(
        "results", {room * 2 * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback});
    board.offer(std::move(probe));
  };
  return effect;
}

}  // namespace

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
  // Where the ray enters the air it looks down at sin(zenith) = closest / top radius. From the camera to there the
  // local frame turns by the difference of the two zenith angles, about the horizontal axis across the view.
  const double entry_zenith = glm::radians(180.0) - std::asin(closest_km / planet.top_radius_km);
  const double turn = entry_zenith - view_zenith;
  sun = {std::cos(turn) * sun.x + std::sin(turn) * sun.z, sun.y, std::cos(turn) * sun.z - std::sin(turn) * sun.x};
  return {{polar(entry_zenith, 0.0), top_km}, {sun, 0.0}};
}
// [/ray]

void add_probe_pass(app::Builder& builder, graph::Resource results, graph::Step step) {
  graph::Pass pass{.name = "probe", .changed = [](const app::Frame&) { return true; }};
  pass.steps.push_back(std::move(step));
  pass.steps.push_back({.accesses = {{results, gpu::kHostRead}}, .record = [](const graph::Recorder&) {}});
  builder.graph.add(std::move(pass));
  builder.graph.set_output(results);
}

ProbeRun::ProbeRun(const app::Context& context, std::vector<app::Effect> effects, size_t most)
    : context_(context), room_(std::min(std::max<size_t>(most, 1), kBatch)) {
  effects.insert(effects.begin(), probe_buffers(room_));
  composition_ = std::make_unique<app::Composition>(context, std::move(effects));
}

std::vector<app::ProbeResult> ProbeRun::run(std::span<const app::ProbeRay> rays, bool of_first_ray) {
  const ProbeBuffers& probe = *composition_->find<ProbeBuffers>();
  const std::span<MarchRay> in = composition_->graph().buffer(probe.rays).as<MarchRay>();
  const std::span<glm::vec4> out = composition_->graph().buffer(probe.results).as<glm::vec4>();
  std::vector<app::ProbeResult> light;
  light.reserve(rays.size());
  for (size_t first = 0; first < rays.size(); first += room_) {
    const size_t count = std::min(room_, rays.size() - first);
    for (size_t i = 0; i < count; ++i) in[i] = march_ray(rays[first + i], context_.scene.planet);
    probe.range->count = static_cast<int32_t>(count);
    CameraRays camera{};
    if (of_first_ray) camera.altitude_km = in[0].view.w, camera.sun = glm::vec3(in[0].sun);
    composition_->execute_once(camera);
    for (size_t i = 0; i < count; ++i) light.push_back({glm::dvec3(out[2 * i]), glm::dvec3(out[2 * i + 1])});
  }
  return light;
}

}  // namespace welkin
