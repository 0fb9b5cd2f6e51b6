// Rays of --probe through clouds and air. See cloud_picture.hpp.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "chapters/05_single_scattering/probe.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "chapters/16_noise/noise.hpp"
#include "chapters/17_cloud_shapes/cloud_picture.hpp"
#include "common/app/camera.hpp"
#include "common/graph/composition.hpp"

namespace welkin {
namespace {

constexpr size_t kBatch = 1 << 16;

struct ProbePush {
  CloudMarchPush march;
  int32_t count;
};

struct CloudProbe {
  graph::Resource rays, results;
  std::shared_ptr<int32_t> count;
};

app::Effect probe_effect(size_t room) {
  app::Effect effect{.name = "cloud probe", .chapter = 17};
  effect.declare = [room](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    CloudProbe probe{.count = std::make_shared<int32_t>(0)};
    probe.rays = builder.graph.add_filled("cloud rays",
                                          gpu::create_buffer(context.device, "cloud rays", room * sizeof(CloudRayItem),
                                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload));
    probe.results = builder.graph.add_buffer(
        "cloud depths", {room * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback});
    graph::Step step{.shader = "17_cloud_shapes/probe.comp",
                     .bindings = {{"Rays", probe.rays}, {"Results", probe.results}}};
    bind_clouds(step, board.get<CloudBodies>("clouds"));
    step.record = [context, count = probe.count](const graph::Recorder& r) {
      r.push(ProbePush{cloud_march(context.settings), *count}).dispatch(static_cast<uint32_t>(*count + 63) / 64);
    };
    add_probe_pass(builder, probe.results, std::move(step));
    board.offer(std::move(probe));
  };
  return effect;
}

}  // namespace

// [item]
// The ray in split precision, from where it comes down to the clouds: found in double, as in chapter 05.
CloudRayItem cloud_ray_item(const app::ProbeRay& ray, double ground_radius_km, double ceiling_km) {
  glm::dvec3 position = ray.position_km;
  double altitude_km = std::max(app::altitude_km({.position_km = position}, ground_radius_km), 0.0);
  const glm::dvec3 from_centre = position + glm::dvec3(0.0, 0.0, ground_radius_km);
  const double r = glm::length(from_centre), along = glm::dot(from_centre, ray.direction);
  const double closest = glm::length(glm::cross(from_centre, ray.direction)), top_km = ground_radius_km + ceiling_km;
  double mu = along / r, sine = closest / r, before_km = 0.0;
  if (altitude_km > ceiling_km && along < 0.0 && closest < top_km) {
    const double root = std::sqrt((top_km - closest) * (top_km + closest));
    before_km = (altitude_km - ceiling_km) * (r + top_km) / (root - along);
    position += ray.direction * before_km;
    mu = -root / top_km, sine = closest / top_km;
  }
  // Whether a ray that grazes the ground meets it, floats cannot say: from 36,000 km they know its tangent point to 2
  // m.
  double end_km = 1e9;
  if (along < 0.0 && closest < ground_radius_km + 1e-9) {  // one that touches it, as double has it, meets it
    const double root = std::sqrt(std::max((ground_radius_km - closest) * (ground_radius_km + closest), 0.0));
    end_km = altitude_km * (r + ground_radius_km) / (root - along) - before_km;
  }
  if (before_km > 0.0) altitude_km = ceiling_km;
  const glm::vec3 origin(position);
  return {glm::vec4(origin, altitude_km), glm::vec4(position - glm::dvec3(origin), mu), glm::vec4(ray.direction, sine),
          glm::vec4(std::max(end_km, 0.0), 0.0, 0.0, 0.0)};
}
// [/item]

// [probe]
std::vector<double> cloud_optical_depths(const app::Context& context, std::span<const app::ProbeRay> rays) {
  std::vector<double> depths(rays.size(), 0.0);
  if (rays.empty() || bodies_of(context.scene).empty()) return depths;
  const size_t room = std::min(rays.size(), kBatch);
  app::Composition composition(context, {noise_textures(), weather_texture(), clouds(), probe_effect(room)});
  const CloudProbe& probe = *composition.find<CloudProbe>();
  const double ceiling_km = composition.find<CloudBodies>()->ceiling_km;
  for (size_t first = 0; first < rays.size(); first += room) {
    const size_t count = std::min(room, rays.size() - first);
    const std::span<CloudRayItem> in = composition.graph().buffer(probe.rays).as<CloudRayItem>();
    for (size_t i = 0; i < count; ++i)
      in[i] = cloud_ray_item(rays[first + i], context.scene.planet.ground_radius_km, ceiling_km);
    *probe.count = static_cast<int32_t>(count);
    composition.execute_once();
    const std::span<float> out = composition.graph().buffer(probe.results).as<float>();
    for (size_t i = 0; i < count; ++i) depths[first + i] = static_cast<double>(out[i]);
  }
  return depths;
}

std::vector<app::ProbeResult> probe_clouds(const app::Context& context, std::span<const app::ProbeRay> rays) {
  std::vector<app::ProbeResult> results(rays.size(), {glm::dvec3(0.0), glm::dvec3(1.0)});
  if (!context.scene.media.empty()) results = probe_sky(context, rays);
  const std::vector<double> depths = cloud_optical_depths(context, rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    results[i].radiance = glm::dvec3(0.0);
    results[i].transmittance *= std::exp(-depths[i]);
  }
  return results;
}
// [/probe]

}  // namespace welkin
