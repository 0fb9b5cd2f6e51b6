// The march's pass. See single_scattering.hpp and docs/chapters/05_single_scattering.md.
#include "chapters/05_single_scattering/single_scattering.hpp"

#include <algorithm>

#include "chapters/05_single_scattering/probe.hpp"

namespace welkin {
namespace {

// [constants]
gpu::Constants march_constants(const app::Context& context) {
  return {{"SUN_DISC", context.scene.sun.disc, true},
          {"RULE", context.settings.integer("rule")},
          {"LIGHT_STEPS", context.settings.integer("light.steps"), true}};
}
// [/constants]

}  // namespace

// [knobs]
// The product of the largest counts stays below 65,535: a software driver silently ends loops there.
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

Knob march_knob(const std::string& name) {
  const std::vector<Knob> knobs = march_knobs();
  return *std::find_if(knobs.begin(), knobs.end(), [&](const Knob& knob) { return knob.name == name; });
}

// [effect]
app::Effect single_scattering() {
  app::Effect effect{.name = "single scattering", .chapter = 5, .knobs = march_knobs()};
  effect.key = [](const Scene& scene, const Settings&) { return fmt::format("{}", scene.sun.disc); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const AirBlock& air = board.get<AirBlock>("the air");
    const graph::Resource picture = builder.picture(board, "picture");
    graph::Pass pass{.name = "march", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back({.shader = "05_single_scattering/image.comp",
                          .constants = joined(air.constants, march_constants(builder.context)),
                          .bindings = {{"Air", air.block}, {"target", picture}},
                          .record = [context = builder.context, picture](const graph::Recorder& r) {
                            r.push(MarchPush{r.frame.camera, context.settings.integer("view.steps"), {}})
                                .dispatch_over(r.graph.image(picture).size);
                          }});
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/effect]

// [probe]
std::vector<app::ProbeResult> probe_single_scattering(const app::Context& context,
                                                      std::span<const app::ProbeRay> rays) {
  app::Effect march{.name = "probe", .chapter = 5};
  march.declare = [](app::Builder& builder, app::Board& board) {
    const AirBlock& air = board.get<AirBlock>("the air");
    const ProbeBuffers& probe = board.get<ProbeBuffers>("the rays of a probe");
    add_probe_pass(builder, probe.results,
                   {.shader = "05_single_scattering/probe.comp",
                    .constants = joined(air.constants, march_constants(builder.context)),
                    .bindings = {{"Air", air.block}, {"Rays", probe.rays}, {"Results", probe.results}},
                    .record = [context = builder.context, range = probe.range](const graph::Recorder& r) {
                      r.push(MarchProbePush{context.settings.integer("view.steps"), range->count, {}});
                      r.dispatch(static_cast<uint32_t>(range->count + 63) / 64);
                    }});
  };
  return ProbeRun(context, {air(), std::move(march)}, rays.size()).run(rays);
}
// [/probe]

}  // namespace welkin
