// The passes that draw chapter 08's pictures and answer its probes. See table_sky.hpp.
#include "chapters/08_transmittance_lut/table_sky.hpp"

#include "chapters/05_single_scattering/probe.hpp"
#include "chapters/05_single_scattering/single_scattering.hpp"

namespace welkin {
namespace {

struct StepsPush {
  int32_t view_steps, count, unused[2];
};

// Shader, constants and bindings that picture and probe share.
graph::Step march_step(const app::Context& context, app::Board& board, const char* shader) {
  const AirBlock& air = board.get<AirBlock>("the air");
  const TransmittanceTable& table = board.get<TransmittanceTable>("a transmittance table");
  gpu::Constants constants = joined(air.constants, table.constants);
  constants.push_back({"SUN_DISC", context.scene.sun.disc, true});
  constants.push_back({"RULE", context.settings.integer("rule")});
  return {.shader = shader,
          .constants = std::move(constants),
          .bindings = {{"Air", air.block}, {"transmittance_table", table.image}}};
}

}  // namespace

// [march]
app::Effect table_march() {
  app::Effect effect{.name = "march", .chapter = 8, .knobs = {march_knob("view.steps"), march_knob("rule")}};
  effect.key = [](const Scene& scene, const Settings&) { return fmt::format("{}", scene.sun.disc); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource picture = builder.picture(board, "picture");
    graph::Step step = march_step(builder.context, board, "08_transmittance_lut/image.comp");
    step.bindings.push_back({"target", picture});
    step.record = [context = builder.context, picture](const graph::Recorder& r) {
      r.push(StepsPush{context.settings.integer("view.steps"), 0, {}}).dispatch_over(r.graph.image(picture).size);
    };
    graph::Pass pass{.name = "march", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/march]

// [probe]
std::vector<app::ProbeResult> probe_table_march(const app::Context& context, std::span<const app::ProbeRay> rays) {
  app::Effect march{.name = "probe", .chapter = 8};
  march.declare = [](app::Builder& builder, app::Board& board) {
    const ProbeBuffers& probe = board.get<ProbeBuffers>("the rays of a probe");
    graph::Step step = march_step(builder.context, board, "08_transmittance_lut/probe.comp");
    step.bindings.push_back({"Rays", probe.rays});
    step.bindings.push_back({"Results", probe.results});
    step.record = [context = builder.context, range = probe.range](const graph::Recorder& r) {
      r.push(StepsPush{context.settings.integer("view.steps"), range->count, {}});
      r.dispatch(static_cast<uint32_t>(range->count + 63) / 64);
    };
    add_probe_pass(builder, probe.results, std::move(step));
  };
  return ProbeRun(context, {air(), transmittance_table(), std::move(march)}, rays.size()).run(rays);
}
// [/probe]

}  // namespace welkin
