// The pass "sky" and its probe. See sky.hpp and docs/chapters/10_sky_view_lut.md.
#include "chapters/10_sky_view_lut/sky.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>

#include "chapters/05_single_scattering/probe.hpp"
#include "chapters/05_single_scattering/single_scattering.hpp"
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "chapters/09_multiple_scattering_lut/all_orders_sky.hpp"

namespace welkin {
namespace {

struct ProbePush {
  int32_t first, count, unused[2];
};

// One look-up per pixel. The sun's disc is drawn attenuated by chapter 08's transmittance table.
graph::Step look_up_step(app::Board& board, bool with_disc) {
  const AirBlock& air = board.get<AirBlock>("the air");
  const SkyViewTable& table = board.get<SkyViewTable>("a sky view table");
  graph::Step step{.shader = "10_sky_view_lut/sky.comp",
                   .constants = joined(air.constants, {{"SKY_VIEW_UNIT", table.unit}}),
                   .bindings = {{"Air", air.block}, {"sky_view_table", table.image}}};
  if (!with_disc) return step;
  const TransmittanceTable& transmittance = board.get<TransmittanceTable>("a transmittance table");
  step.shader = "10_sky_view_lut/sky_disc.comp";
  step.constants = joined(step.constants, transmittance.constants);
  step.bindings.push_back({"transmittance_table", transmittance.image});
  return step;
}

// Whether the sun's disc may be in the picture: within the cone around the view direction that contains the picture's
// corners.
bool sun_in_picture(const Scene& scene, const CameraRays& camera) {
  const double corner = std::atan(std::hypot(glm::length(camera.right), glm::length(camera.up)));
  const double margin = 1e-3 + glm::radians(scene.sun.angular_radius_deg);
  return glm::dot(camera.forward, camera.sun) >= std::cos(std::min(corner + margin, glm::radians(180.0)));
}

}  // namespace

// [sky]
// The pass has three steps, and one of them draws each frame: the look-up with the sun's disc, the look-up where the
// disc is out of the picture, and the march.
app::Effect sky() {
  app::Effect effect{.name = "sky", .chapter = 10, .knobs = {march_knob("view.steps")}};
  effect.knobs.front().ladder.clear();  // swept in chapter 05
  effect.key = [](const Scene& scene, const Settings&) { return fmt::format("{}", scene.sun.disc); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const graph::Resource picture = builder.picture(board, "sky");
    const bool has_orders = board.find<MultipleScatteringTable>() != nullptr;
    const auto dispatch = [picture](const graph::Recorder& r) { r.dispatch_over(r.graph.image(picture).size); };
    graph::Pass pass{.name = "sky", .changed = [](const app::Frame&) { return true; }};
    const auto add = [&](graph::Step step, auto when, auto record) {
      step.bindings.push_back({"target", picture});
      step.when = [context, when](const graph::Recorder& r) {
        const CameraRays& camera = r.frame.camera;
        return when(uses_sky_view_table(context.settings, camera.altitude_km),
                    context.scene.sun.disc && sun_in_picture(context.scene, camera));
      };
      step.record = record;
      pass.steps.push_back(std::move(step));
    };
    if (context.scene.sun.disc)
      add(
          look_up_step(board, true), [](bool use_table, bool sun) { return use_table && sun; }, dispatch);
    add(
        look_up_step(board, false), [](bool use_table, bool sun) { return use_table && !sun; }, dispatch);
    add(
        all_orders_step(context, board, "image"), [](bool use_table, bool) { return !use_table; },
        [context, picture, has_orders](const graph::Recorder& r) {
          record_all_orders(context, r, has_orders, r.graph.image(picture).size);
        });
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/sky]

// [probe]
static app::Effect probe_look_up() {
  app::Effect effect{.name = "probe", .chapter = 10};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const AirBlock& air = board.get<AirBlock>("the air");
    const SkyViewTable& table = board.get<SkyViewTable>("a sky view table");
    const ProbeBuffers& probe = board.get<ProbeBuffers>("the rays of a probe");
    add_probe_pass(builder, probe.results,
                   {.shader = "10_sky_view_lut/probe.comp",
                    .constants = joined(air.constants, {{"SKY_VIEW_UNIT", table.unit}}),
                    .bindings = {{"Air", air.block},
                                 {"sky_view_table", table.image},
                                 {"Rays", probe.rays},
                                 {"Results", probe.results}},
                    .record = [range = probe.range](const graph::Recorder& r) {
                      r.push(ProbePush{0, range->count, {}});
                      r.dispatch(static_cast<uint32_t>(range->count + 63) / 64);
                    }});
  };
  return effect;
}

std::vector<app::ProbeResult> probe_sky(const app::Context& context, std::span<const app::ProbeRay> rays) {
  std::map<std::pair<double, double>, std::vector<size_t>> groups;
  std::vector<size_t> marched;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (uses_sky_view_table(context.settings, rays[i].altitude_km))
      groups[{rays[i].altitude_km, rays[i].sun_zenith_deg}].push_back(i);
    else
      marched.push_back(i);
  }
  std::vector<app::ProbeResult> results(rays.size());
  const auto fill_results = [&](const std::vector<size_t>& members, const auto& probe) {
    std::vector<app::ProbeRay> subset;
    for (const size_t i : members) subset.push_back(rays[i]);
    const std::vector<app::ProbeResult> light = probe(subset);
    for (size_t k = 0; k < members.size(); ++k) results[members[k]] = light[k];
  };
  if (!marched.empty()) fill_results(marched, [&](const auto& subset) { return probe_all_orders(context, subset); });
  if (groups.empty()) return results;
  size_t largest_group = 0;
  for (const auto& [key, members] : groups) largest_group = std::max(largest_group, members.size());
  ProbeRun run(context, {air(), multiple_scattering_table(), sky_view(), probe_look_up()}, largest_group);
  for (const auto& [key, members] : groups)
    fill_results(members, [&](const auto& subset) { return run.run(subset, true); });
  return results;
}
// [/probe]

}  // namespace welkin
