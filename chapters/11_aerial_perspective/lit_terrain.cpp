// The pass "compose". See lit_terrain.hpp.
#include "chapters/11_aerial_perspective/lit_terrain.hpp"

#include "chapters/11_aerial_perspective/signs.hpp"

namespace welkin {
namespace {

// As compose.glsl has it: 128 bytes, all that every device has.
struct ComposePush {
  AerialPush air;
  float unused[2];
  SignPlaces signs;
};

}  // namespace

// [compose]
app::Effect lit_terrain() {
  app::Effect effect{.name = "lit terrain", .chapter = 11};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    if (!scene.terrain) return {false, "no [terrain] in scene: the sky is the picture"};
    return {true, has_signs(scene)
                      ? fmt::format("terrain, and signs in direction {}", *scene.terrain->signs_azimuth_deg)
                      : "terrain, no signs"};
  };
  // Knobs of the froxels that the march per pixel is compiled with, too: without froxels nothing else tells of them.
  effect.key = [](const Scene& scene, const Settings& settings) {
    std::string key = has_signs(scene) ? "signs " : "";
    for (const char* knob : {"aerial.march_slices", "froxels.slices", "froxels.samples", "froxels.power",
                             "terrain.edges", "terrain.detail"})
      key += fmt::format("{} ", settings.number(knob));
    return key;
  };
  // [declare]
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const TerrainMaps& maps = board.get<TerrainMaps>("terrain");
    const graph::Resource sky_picture = board.get<app::Picture>("a sky").image;
    const Froxels* froxels = board.find<Froxels>();
    const graph::Resource picture = builder.picture(board, "picture");
    graph::Step step = aerial_step(context, board, froxels != nullptr ? "compose.comp" : "compose_march.comp");
    step.constants.push_back({"MARCH_SLICES", context.settings.integer("aerial.march_slices")});
    step.constants.push_back({"HAS_EDGES", context.settings.choice("terrain.edges") == "on"});
    step.constants.push_back({"HAS_DETAIL", context.settings.choice("terrain.detail") == "on"});
    step.bindings.insert(step.bindings.end(), {{"terrain_distance", maps.distance},
                                               {"slope_map", maps.slopes},
                                               {"cover_map", maps.cover},
                                               {"sky", sky_picture},
                                               {"target", picture}});
    step.constants.push_back({"HAS_SIGNS", has_signs(context.scene)});
    if (froxels != nullptr)
      step.bindings.insert(step.bindings.end(), {{"froxel_in_scattering", froxels->in_scattering},
                                                 {"froxel_extinction", froxels->extinction}});
    step.record = [context, picture](const graph::Recorder& r) {
      r.push(ComposePush{aerial_push(context), {}, sign_places(context.scene)})
          .dispatch_over(r.graph.image(picture).size);
    };
    graph::Pass pass{.name = "compose", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  // [/declare]
  return effect;
}
// [/compose]

}  // namespace welkin
