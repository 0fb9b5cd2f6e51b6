// The passes that draw chapter 09's pictures and answer its probes. See all_orders_sky.hpp.
#include "chapters/09_multiple_scattering_lut/all_orders_sky.hpp"

#include "chapters/05_single_scattering/probe.hpp"
#include "chapters/05_single_scattering/single_scattering.hpp"

namespace welkin {

// [march]
// Without the table chapter 05's shaders draw single scattering.
graph::Step all_orders_step(const app::Context& context, app::Board& board, const std::string& shader) {
  const AirBlock& air = board.get<AirBlock>("the air");
  const MultipleScatteringTable* table = board.find<MultipleScatteringTable>();
  gpu::Constants constants = air.constants;
  constants.push_back({"SUN_DISC", context.scene.sun.disc, true});
  if (table == nullptr) {
    constants.push_back({"RULE", kRuleAdapted});
    constants.push_back({"LIGHT_STEPS", 1, true});
    return {
        .shader = "05_single_scattering/" + shader + ".comp", .constants = constants, .bindings = {{"Air", air.block}}};
  }
  return {.shader = "09_multiple_scattering_lut/" + shader + ".comp",
          .constants = joined(constants, table->constants),
          .bindings = {{"Air", air.block}, {"table", table->image}}};
}

void record_all_orders(const app::Context& context, const graph::Recorder& r, bool has_table, VkExtent2D size) {
  const int view_steps = context.settings.integer("view.steps");
  if (has_table)
    r.push(MarchSteps{view_steps, context.settings.integer("multiple_scattering.view_steps"), 0, 0});
  else
    r.push(MarchPush{r.frame.camera, view_steps, {}});
  r.dispatch_over(size);
}

app::Effect all_orders_march() {
  app::Effect effect{.name = "march", .chapter = 9, .knobs = {march_knob("view.steps")}};
  effect.key = [](const Scene& scene, const Settings&) { return fmt::format("{}", scene.sun.disc); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource picture = builder.picture(board, "picture");
    graph::Step step = all_orders_step(builder.context, board, "image");
    step.bindings.push_back({"target", picture});
    step.record = [context = builder.context, picture,
                   has_table = board.find<MultipleScatteringTable>() != nullptr](const graph::Recorder& r) {
      record_all_orders(context, r, has_table, r.graph.image(picture).size);
    };
    graph::Pass pass{.name = "march", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/march]

// [probe]
std::vector<app::ProbeResult> probe_all_orders(const app::Context& context, std::span<const app::ProbeRay> rays) {
  app::Effect march{.name = "probe", .chapter = 9};
  march.declare = [](app::Builder& builder, app::Board& board) {
    const ProbeBuffers& probe = board.get<ProbeBuffers>("the rays of a probe");
    graph::Step step = all_orders_step(builder.context, board, "probe");
    step.bindings.push_back({"Rays", probe.rays});
    step.bindings.push_back({"Results", probe.results});
    step.record = [context = builder.context, range = probe.range,
                   has_table = board.find<MultipleScatteringTable>() != nullptr](const graph::Recorder& r) {
      const int view_steps = context.settings.integer("view.steps");
      if (has_table)
        r.push(MarchSteps{view_steps, context.settings.integer("multiple_scattering.view_steps"), range->count, 0});
      else
        r.push(MarchProbePush{view_steps, range->count, {}});
      r.dispatch(static_cast<uint32_t>(range->count + 63) / 64);
    };
    add_probe_pass(builder, probe.results, std::move(step));
  };
  return ProbeRun(context, {air(), multiple_scattering_table(), std::move(march)}, rays.size()).run(rays);
}
// [/probe]

}  // namespace welkin
