// Filling the froxels. See aerial_perspective.hpp and docs/chapters/11_aerial_perspective.md.
#include "chapters/11_aerial_perspective/aerial_perspective.hpp"

#include <glm/trigonometric.hpp>

namespace welkin {
namespace {

constexpr uint32_t kWorkgroup = 64;  // as in froxels.comp

bool per_channel(const Settings& settings) { return settings.choice("froxels.transmittance") == "colour"; }

// Number of shader invocations that share one direction of the grid.
int threads_of(const app::Context& context) {
  const std::string& wanted = context.settings.choice("froxels.threads");
  if (wanted != "auto") return std::stoi(wanted);
  return context.device.candidate().software ? 1 : 32;
}

}  // namespace

// [knobs]
std::vector<Knob> froxel_knobs() {
  return {
      {.name = "aerial.method",
       .meaning = "where the air before terrain comes from: froxels, or a march per pixel",
       .initial = 0,
       .choices = {"froxels", "march"},
       .rebuilds = true},
      {.name = "aerial.march_slices",
       .unit = "slices",
       .meaning = "of the march per pixel",
       .minimum = 4,
       .maximum = 512,
       .initial = 64,
       .integer = true,
       .rebuilds = true},
      {.name = "froxels.size",
       .unit = "texels",
       .meaning = "directions across the picture, and down",
       .minimum = 4,
       .maximum = 128,
       .initial = 32,
       .integer = true,
       .ladder = {16, 32, 64},
       .rebuilds = true},
      {.name = "froxels.slices",
       .unit = "slices",
       .meaning = "behind each other",
       .minimum = 4,
       .maximum = 256,
       .initial = 32,
       .integer = true,
       .ladder = {16, 32, 64},
       .rebuilds = true},
      {.name = "froxels.samples",
       .unit = "samples",
       .meaning = "in a slice: 1, or pairs of Gauss nodes",
       .minimum = 1,
       .maximum = 8,
       .initial = 2,
       .integer = true,
       .rebuilds = true},
      {.name = "froxels.power",
       .meaning = "the far end of slice s of n lies at (s/n)^power of the distance",
       .minimum = 1,
       .maximum = 4,
       .initial = 2,
       .rebuilds = true},
      {.name = "froxels.distance_km",
       .unit = "km",
       .meaning = "where the last slice ends; the march serves what lies beyond",
       .minimum = 1,
       .maximum = 1000,
       .initial = 128},
      {.name = "froxels.threads",
       .unit = "threads",
       .meaning = "that share a direction, a slice each; auto: 32, but on a processor, where only their sum counts, 1",
       .initial = 0,
       .choices = {"auto", "1", "8", "32"},
       .rebuilds = true},
      {.name = "froxels.transmittance",
       .meaning = "kept as the mean of the channels, or per channel in an image of its own",
       .initial = 1,
       .choices = {"mean", "colour"},
       .rebuilds = true}};
}
// [/knobs]

AerialPush aerial_push(const app::Context& context) {
  return {static_cast<float>(context.scene.terrain->extent_km),
          static_cast<float>(context.settings.number("froxels.distance_km"))};
}

// [inputs]
// Where there is no table, or no shadow map, the cover map is bound in its place; the shader does not read it.
graph::Step aerial_step(const app::Context& context, app::Board& board, const std::string& shader) {
  const Settings& settings = context.settings;
  const AirBlock& air = board.get<AirBlock>("the air");
  const TerrainMaps& maps = board.get<TerrainMaps>("terrain");
  const MultipleScatteringTable* table = board.find<MultipleScatteringTable>();
  const TerrainShadows* shadows = board.find<TerrainShadows>();
  const int samples = settings.integer("froxels.samples");
  graph::Step step{
      .shader = "11_aerial_perspective/" + shader,
      .constants = joined(air.constants, {{"HIGHER_ORDERS", table != nullptr},
                                          {"HAS_SHADOWS", shadows != nullptr},
                                          {"HAS_COLOUR", per_channel(settings)},
                                          {"SLICES", settings.integer("froxels.slices")},
                                          {"SAMPLES", samples == 1 ? 1 : (samples + 1) / 2 * 2},
                                          {"POWER", static_cast<float>(settings.number("froxels.power"))}}),
      .bindings = {{"Air", air.block},
                   {"multiple_scattering_table", table != nullptr ? table->image : maps.cover},
                   {"shadow_map", shadows != nullptr ? shadows->image : maps.cover}}};
  if (table != nullptr)
    step.constants = joined(step.constants, table->constants);
  else
    step.constants = joined(step.constants, {{"MS_METHOD", 0, true}, {"MS_MAP", 0, true}, {"MS_SIZE", 1, true}});
  return step;
}
// [/inputs]

// [passes]
app::Effect aerial_perspective() {
  app::Effect effect{.name = "aerial perspective", .chapter = 11, .knobs = froxel_knobs()};
  effect.wanted = [](const Scene& scene, const Settings& settings) -> app::Wanted {
    if (!scene.terrain) return {false, "no [terrain] in scene"};
    if (settings.choice("aerial.method") == "march") return {false, "aerial.method is march: per pixel, no froxels"};
    return {true, "froxels before the terrain"};
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const uint32_t side = static_cast<uint32_t>(context.settings.integer("froxels.size")),
                   slices = static_cast<uint32_t>(context.settings.integer("froxels.slices"));
    // 32 bits: at dusk radiance falls to a millionth of noon's; a half loses digits below 6e-5 and has none below 6e-8.
    const graph::ImageInfo grid{.size = {side, side}, .depth = slices};
    const bool colour = per_channel(context.settings);
    const graph::Resource in_scattering = builder.graph.add_image("froxels", grid);
    const graph::Resource extinction = colour ? builder.graph.add_image("froxel extinction", grid) : in_scattering;
    board.offer(Froxels{in_scattering, extinction});

    const int threads = threads_of(context);
    graph::Step step = aerial_step(context, board, colour ? "froxels.comp" : "froxels_mean.comp");
    step.constants.push_back({"THREADS", threads});
    step.bindings.push_back({"froxel_in_scattering", in_scattering});
    if (colour) step.bindings.push_back({"froxel_extinction", extinction});
    const auto seen = std::make_shared<ViewChange>();
    const auto reach_km = std::make_shared<float>(0.0f);
    step.record = [context, seen, reach_km, side,
                   rays = kWorkgroup / static_cast<uint32_t>(threads)](const graph::Recorder& r) {
      seen->note(r.frame);
      const AerialPush push = aerial_push(context);
      *reach_km = push.farthest_km;
      r.push(push).dispatch((side * side + rays - 1) / rays);
    };
    graph::Pass pass{.name = "aerial perspective"};
    pass.changed = [context, seen, reach_km](const app::Frame& frame) {
      return seen->differs(frame) || *reach_km != aerial_push(context).farthest_km;
    };
    pass.needed = [context](const app::Frame& frame) {
      return frame.camera.altitude_km < context.scene.planet.top_radius_km - context.scene.planet.ground_radius_km;
    };
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/passes]

}  // namespace welkin
